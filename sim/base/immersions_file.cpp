#include "sim/base/immersions_file.h"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "sim/base/checked_json.h"

namespace hydroprint {
namespace {

constexpr const char* kExample =
    R"(. Write [{"rotation_wxyz": [1, 0, 0, 0], "translation_mm": [0, 0, 0], "depth_mm": "full"}])";

Status need_keys(const nlohmann::json& dip, const std::string& where) {
  for (const char* key : {"rotation_wxyz", "translation_mm"}) {
    if (!dip.contains(key))
      return fail(Code::kInvalidArgument, fmt::format("{}: {} is missing{}", where, key, kExample));
  }
  return {};
}

/// Checks the length of a quaternion, which parse_pose() would normalise.
Status check_length(const nlohmann::json& wxyz, const std::string& where) {
  Eigen::Vector4d q;
  for (std::size_t i = 0; i < 4; ++i) q[static_cast<Eigen::Index>(i)] = wxyz[i].get<double>();
  if (is_unit(q)) return {};
  return fail(Code::kInvalidArgument,
              fmt::format("{}: rotation_wxyz: {}", where, not_unit_problem(q)));
}

Result<std::optional<double>> read_depth(const nlohmann::json& depth, const std::string& where) {
  if (depth == "full") return std::nullopt;
  const bool is_positive = depth.is_number() && depth.get<double>() > 0;
  if (is_positive) return depth.get<double>();
  return fail(depth.is_number() ? Code::kOutOfRange : Code::kInvalidArgument,
              fmt::format("{}: depth_mm: {} is not a depth. Write a number of mm above 0, or "
                          "\"full\"",
                          where, depth.dump()));
}

Result<ListedDip> read_dip(nlohmann::json dip, const std::string& where) {
  if (!dip.is_object()) return fail(Code::kInvalidArgument, where + ": not a dip" + kExample);
  HP_RETURN_IF_ERROR(need_keys(dip, where));
  ListedDip out;
  if (dip.contains("depth_mm")) {
    HP_ASSIGN_OR_RETURN(out.depth_mm, read_depth(dip["depth_mm"], where));
    dip.erase("depth_mm");
  }
  HP_ASSIGN_OR_RETURN(out.pose, parse_pose(dip, where));
  HP_RETURN_IF_ERROR(check_length(dip["rotation_wxyz"], where));
  return out;
}

}  // namespace

Result<std::vector<ListedDip>> read_immersions_file(const std::filesystem::path& path) {
  HP_ASSIGN_OR_RETURN(const nlohmann::json json, read_json_file(path));
  return parse_immersions(json, path.string());
}

Result<std::vector<ListedDip>> parse_immersions(const nlohmann::json& json,
                                                const std::string& name) {
  if (!json.is_array())
    return fail(Code::kInvalidArgument, name + ": not a list of dips" + kExample);
  if (json.empty())
    return fail(Code::kInvalidArgument, name + ": no dips. List at least one" + kExample);
  if (json.size() > kMostDips) {
    return fail(Code::kInvalidArgument,
                fmt::format("{}: {} dips. List at most {}", name, json.size(), kMostDips));
  }
  std::vector<ListedDip> out;
  for (std::size_t i = 0; i < json.size(); ++i) {
    HP_ASSIGN_OR_RETURN(ListedDip dip, read_dip(json[i], fmt::format("{}: dip {}", name, i + 1)));
    out.push_back(std::move(dip));
  }
  return out;
}

}  // namespace hydroprint
