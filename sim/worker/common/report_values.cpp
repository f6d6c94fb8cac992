#include "sim/worker/common/report_values.h"

#include <Eigen/Geometry>
#include <cctype>

#include "hydroprint/v1/report.pb.h"
#include "sim/base/utf8.h"

namespace hydroprint::worker {
namespace {

/// Returns the code of the .proto file for a code in snake_case.
v1::ReportWarning::Code code_of(std::string code) {
  for (char& c : code) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  v1::ReportWarning::Code out = v1::ReportWarning::CODE_UNSPECIFIED;
  (void)v1::ReportWarning::Code_Parse(code, &out);
  return out;
}

}  // namespace

Json pair_of(const Eigen::Vector2d& v) { return {v.x(), v.y()}; }

Json list_of(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Json pose_json(const Pose& X_FO) {
  const Eigen::Quaterniond q(X_FO.linear());
  return {{"rotation_wxyz", {q.w(), q.x(), q.y(), q.z()}},
          {"translation_mm", list_of(X_FO.translation())}};
}

Json film_json(const film::Outline& outline) {
  return {{"name", outline.name},
          {"min_mm", pair_of(outline.min_mm)},
          {"max_mm", pair_of(outline.max_mm)},
          {"corners", outline.polygon.size()}};
}

Json warnings_json(const Warnings& warnings) {
  Json out = Json::array();
  for (const Warning& warning : warnings) {
    out.push_back({{"code", warning.code}, {"message", warning.message}, {"where", warning.where}});
  }
  return out;
}

std::string utf8(const std::string& text) { return encode_utf8(decode_utf8(text)); }

void set_warning(const Warning& warning, v1::ReportWarning& out) {
  out.set_code(code_of(warning.code));
  out.set_message(utf8(warning.message));
  out.set_where(utf8(warning.where));
}

Json mesh_json(const MeshSize& size) {
  return {{"vertices", size.vertices}, {"triangles", size.triangles}};
}

}  // namespace hydroprint::worker
