#include "sim/worker/fuse_json.h"

#include <array>
#include <cstdio>

#include "sim/worker/calibrate_json.h"

namespace hydroprint::worker {
namespace {

double length_mm(const scan::Path& path) {
  double out = 0;
  for (std::size_t i = 1; i < path.X_WC.size(); ++i)
    out += (path.X_WC[i].translation() - path.X_WC[i - 1].translation()).norm();
  return out;
}

}  // namespace

nlohmann::ordered_json swept_json(const calibrate::SweptScan& swept) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : swept.mesh.points_mm) box.extend(p);
  const scan::Path& path = swept.path;
  nlohmann::ordered_json out = {{"frames_tracked", path.X_WC.size() - path.lost()},
                                {"frames_lost", path.lost()},
                                {"rms_mm", path.rms_mm},
                                {"path_mm", length_mm(path)},
                                {"vertices", swept.mesh.points_mm.size()},
                                {"triangles", swept.mesh.triangles.size()},
                                {"min_mm", {box.min().x(), box.min().y(), box.min().z()}},
                                {"max_mm", {box.max().x(), box.max().y(), box.max().z()}},
                                {"frame", swept.film_frame ? "film" : "camera at its first frame"}};
  if (swept.film_frame) out["film_frame"] = film_frame_json(*swept.film_frame);
  return out;
}

std::string swept_text(const calibrate::SweptScan& swept, const std::filesystem::path& dir) {
  std::array<char, 200> figures{};
  std::snprintf(figures.data(), figures.size(),
                "%zu frames, %zu of them lost; smoothed, they lie within %.2f mm (rms) of the "
                "surface of %zu triangles\n",
                swept.path.X_WC.size(), swept.path.lost(), swept.path.rms_mm,
                swept.mesh.triangles.size());
  return dir.string() + ": scan.ply scan.png camera_path.csv report.json\n" + figures.data();
}

}  // namespace hydroprint::worker
