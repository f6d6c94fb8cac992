#include "sim/worker/calibrate_json.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdio>
#include <vector>

namespace hydroprint::worker {
namespace {

using Json = nlohmann::ordered_json;

Json list_of(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Json matrix_json(const registration::Matrix6& matrix) {
  Json out = Json::array();
  for (const auto& row : matrix.rowwise())
    out.push_back(std::vector<double>(row.begin(), row.end()));
  return out;
}

double share_of(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

Json markers_json(const std::vector<registration::MarkerReport>& markers) {
  Json out = Json::array();
  for (const auto& m : markers) {
    out.push_back({{"name", m.name}, {"used", m.used}});
    if (m.used)
      out.back().update({{"rms_mm", m.rms_mm}, {"residual_mm", m.residual_mm}});
    else
      out.back()["why_not"] = m.why_not;
  }
  return out;
}

Json scan_json(const registration::ObjectPose& object) {
  return {{"points", object.fit.points},
          {"on_object_share", object.on_share},
          {"misfit_mm", object.misfit_mm},
          {"rms_mm", object.fit.rms_mm},
          {"rms_sigmas", object.fit.rms_sigmas},
          {"out_of_view_share", object.sight.out_of_view},
          {"hidden_share", object.sight.before + object.sight.without_depth}};
}

}  // namespace

Json pose_json(const Pose& X_FO) {
  const Eigen::Quaterniond q(X_FO.linear());
  return {{"rotation_wxyz", {q.w(), q.x(), q.y(), q.z()}},
          {"translation_mm", list_of(X_FO.translation())}};
}

Json film_frame_json(const registration::FilmFrame& frame) {
  return {{"camera", pose_json(frame.X_CF().inverse())},
          {"rms_mm", frame.fit.rms_mm},
          {"markers", markers_json(frame.markers)}};
}

Json calibration_json(const calibrate::Calibration& c, double lowest_mm) {
  Json out = {{"pose", pose_json(c.object.X_FO)},
              {"uncertainty",
               {{"about_mm", list_of(c.object.centre_mm)},
                {"covariance_turn_rad_shift_mm", matrix_json(c.object.covariance)},
                {"error_p50_mm", share_of(c.error_mm, 0.5)},
                {"error_p95_mm", share_of(c.error_mm, 0.95)},
                {"error_max_mm", share_of(c.error_mm, 1)}}},
              {"from_nominal_pose", c.object.weak},
              {"film_frame", film_frame_json(c.film_frame)},
              {"scan", scan_json(c.object)}};
  if (c.water)
    out["water"] = {{"z_mm", c.water->z_mm}, {"sigma_mm", c.water->sigma_mm}};
  else
    out["water"] = nullptr;
  out["height_mm"] = lowest_mm - (c.water ? c.water->z_mm : 0);
  return out;
}

std::string calibration_text(const calibrate::Calibration& c, const std::filesystem::path& dir) {
  const auto used = std::count_if(c.film_frame.markers.begin(), c.film_frame.markers.end(),
                                  [](const auto& m) { return m.used; });
  std::array<char, 200> figures{};
  std::snprintf(figures.data(), figures.size(),
                "%d of %zu markers; the object lies within %.2f mm of the mesh, its place is known "
                "to %.2f mm\n",
                static_cast<int>(used), c.film_frame.markers.size(), c.object.fit.rms_mm,
                share_of(c.error_mm, 0.95));
  std::string weak;
  for (const std::string& what : c.object.weak) weak += "from the nominal pose: " + what + "\n";
  return dir.string() + ": calibration.json pose.json alignment.png error.png report.json\n" +
         figures.data() + weak;
}

std::string camera_text(const registration::CameraCalibration& camera,
                        const std::filesystem::path& dir) {
  std::array<char, 200> figures{};
  std::snprintf(figures.data(), figures.size(),
                "%zu views; focal length %.1f px, depths %+.2f %%; the board fits to %.2f mm\n",
                camera.views, camera.lens.fx_px, 100 * (camera.lens.depth_scale - 1),
                camera.rms_mm);
  return dir.string() + ": camera.json report.json\n" + figures.data();
}

}  // namespace hydroprint::worker
