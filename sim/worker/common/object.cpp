#include "sim/worker/common/object.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "hydroprint/v1/spec.pb.h"
#include "sim/base/pose_file.h"
#include "sim/film/outline.h"
#include "sim/worker/common/fields.h"

namespace hydroprint::worker {
namespace {

/// Adds the numbers under `key`, unless there are none.
void add_key(nlohmann::json& json, const std::string& key,
             const google::protobuf::RepeatedField<double>& numbers) {
  if (!numbers.empty()) json[key] = std::vector<double>(numbers.begin(), numbers.end());
}

bool all_finite(const google::protobuf::RepeatedField<double>& numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
}

}  // namespace

InputPath film_file(const std::string& film) {
  return {"film", film::polygon_file(film).value_or("")};
}

Result<Pose> pose_of(const v1::Pose& pose) {
  if (!all_finite(pose.rotation_wxyz()) || !all_finite(pose.translation_mm())) {
    return fail_field(Code::kInvalidArgument, "pose", "contains a number that is not finite");
  }
  nlohmann::json json = nlohmann::json::object();
  add_key(json, "rotation_wxyz", pose.rotation_wxyz());
  add_key(json, "translation_mm", pose.translation_mm());
  const auto file = parse_pose(json, "pose");
  if (!file) {
    // The message is "pose: rotation_wxyz: ...". Its first word is removed, because the
    // error names the field apart.
    return fail_field(file.error().code, "pose",
                      file.error().message.substr(std::string("pose: ").size()));
  }
  return file->pose();
}

Warnings pose_warnings_of(const v1::Pose& pose) {
  return pose_warnings(uncertainty_of(pose), {OfItem{"pose"}});
}

}  // namespace hydroprint::worker
