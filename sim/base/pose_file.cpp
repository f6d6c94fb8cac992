#include "sim/base/pose_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "sim/base/checked_json.h"

namespace hydroprint {
namespace {

constexpr double kMaxTranslation_mm = 1e6;
constexpr double kMinQuaternion = 1e-6;
constexpr double kUnitTolerance = 1e-3;

template <int size>
Result<Eigen::Vector<double, size>> read_vector(const std::string& where,
                                                const nlohmann::json& json) {
  const std::string wanted = fmt::format(
      "{0}: not a list of {1} numbers. Write {1} numbers in square brackets", where, size);
  if (!json.is_array() || json.size() != size) return fail(Code::kInvalidArgument, wanted);
  Eigen::Vector<double, size> out;
  for (int i = 0; i < size; ++i) {
    const auto& number = json[static_cast<std::size_t>(i)];
    if (!number.is_number()) return fail(Code::kInvalidArgument, wanted);
    out[i] = number.get<double>();
  }
  return out;
}

Result<Eigen::Vector4d> read_rotation(const std::string& where, const nlohmann::json& json) {
  HP_ASSIGN_OR_RETURN(const Eigen::Vector4d wxyz, read_vector<4>(where, json));
  const double length = wxyz.stableNorm();
  if (!(length >= kMinQuaternion)) {
    return fail(Code::kInvalidArgument, where +
                                            ": the quaternion is too close to zero to be a "
                                            "rotation. Use [1, 0, 0, 0] for no rotation");
  }
  return Eigen::Vector4d(wxyz / length);
}

Result<Eigen::Vector3d> read_translation(const std::string& where, const nlohmann::json& json) {
  HP_ASSIGN_OR_RETURN(const Eigen::Vector3d xyz_mm, read_vector<3>(where, json));
  if (!(xyz_mm.cwiseAbs().maxCoeff() <= kMaxTranslation_mm)) {
    return fail(Code::kOutOfRange,
                where + ": a coordinate exceeds 1e6 mm. Check that the translation is in mm");
  }
  return xyz_mm;
}

Result<double> read_error(const std::string& where, const nlohmann::json& json) {
  if (json.is_number() && json.get<double>() >= 0) return json.get<double>();
  return fail(Code::kInvalidArgument, where + ": not an error in mm. Write 0 or a larger number");
}

Result<std::vector<std::string>> read_motions(const std::string& where,
                                              const nlohmann::json& json) {
  const auto is_text = [](const nlohmann::json& item) { return item.is_string(); };
  if (json.is_array() && std::all_of(json.begin(), json.end(), is_text))
    return json.get<std::vector<std::string>>();
  return fail(Code::kInvalidArgument,
              where + ": not a list of texts. Write texts in square brackets, or leave it out");
}

}  // namespace

Pose PoseFile::pose() const {
  const auto& q = rotation_wxyz;
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
  pose.translation() = translation_mm;
  return pose;
}

bool is_unit(const Eigen::Vector4d& rotation_wxyz) {
  return std::abs(rotation_wxyz.stableNorm() - 1) <= kUnitTolerance;
}

std::string not_unit_problem(const Eigen::Vector4d& rotation_wxyz) {
  return fmt::format(
      "the quaternion has length {:.4g} instead of 1, so it may not be the rotation that is meant. "
      "Divide its numbers by its length",
      rotation_wxyz.stableNorm());
}

Result<PoseFile> read_pose_file(const std::filesystem::path& path) {
  HP_ASSIGN_OR_RETURN(const nlohmann::json json, read_json_file(path));
  return parse_pose(json, path.string());
}

Result<PoseFile> parse_pose(const nlohmann::json& json, const std::string& name) {
  const std::string example =
      R"(. Write {"rotation_wxyz": [1, 0, 0, 0], "translation_mm": [0, 0, 0]})";
  if (!json.is_object()) {
    return fail(Code::kInvalidArgument, name + ": not a pose" + example);
  }
  PoseFile file;
  for (const auto& [key, value] : json.items()) {
    std::string where = name + ": " + key;
    if (key == "rotation_wxyz") {
      HP_ASSIGN_OR_RETURN(file.rotation_wxyz, read_rotation(where, value));
    } else if (key == "translation_mm") {
      HP_ASSIGN_OR_RETURN(file.translation_mm, read_translation(where, value));
    } else if (key == "error_p95_mm") {
      HP_ASSIGN_OR_RETURN(file.uncertainty.error_p95_mm, read_error(where, value));
    } else if (key == "from_nominal_pose") {
      HP_ASSIGN_OR_RETURN(file.uncertainty.from_nominal_pose, read_motions(where, value));
    } else {
      return fail(Code::kInvalidArgument, where.append(": not a known key").append(example));
    }
  }
  return file;
}

}  // namespace hydroprint
