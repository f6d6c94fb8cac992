#include "client/pose_file.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "client/files.h"

namespace hydroprint::client {
namespace {

constexpr std::int64_t kMaxBytes = 65536;
constexpr char kForm[] = R"({"rotation_wxyz":[w,x,y,z],"translation_mm":[x,y,z]})";

tl::unexpected<Error> refuse(const std::filesystem::path& path, const std::string& what) {
  return fail(Code::kInvalidArgument,
              path.string() + ": " + what + "; the file must read " + kForm);
}

template <std::size_t size>
Status read_numbers(const std::filesystem::path& path, const nlohmann::json& pose,
                    const std::string& key, std::array<double, size>& numbers) {
  const auto found = pose.find(key);
  if (found == pose.end()) return {};
  if (!found->is_array() || found->size() != size)
    return refuse(path, "'" + key + "' needs " + std::to_string(size) + " numbers");
  for (std::size_t i = 0; i < size; ++i) {
    const nlohmann::json& number = (*found)[i];
    if (!number.is_number() || !std::isfinite(number.template get<double>()))
      return refuse(path, "number " + std::to_string(i + 1) + " of '" + key + "' is none");
    numbers[i] = number.template get<double>();
  }
  return {};
}

}  // namespace

Result<PoseSpec> read_pose_file(const std::filesystem::path& path) {
  HP_ASSIGN_OR_RETURN(const std::string text, read_text(path, kMaxBytes));
  const auto json = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object()) return refuse(path, "not a JSON object");
  for (const auto& [key, value] : json.items())
    if (key != "rotation_wxyz" && key != "translation_mm")
      return refuse(path, "unknown key '" + key + "'");
  PoseSpec pose;
  HP_RETURN_IF_ERROR(read_numbers(path, json, "rotation_wxyz", pose.rotation_wxyz));
  HP_RETURN_IF_ERROR(read_numbers(path, json, "translation_mm", pose.translation_mm));
  return pose;
}

}  // namespace hydroprint::client
