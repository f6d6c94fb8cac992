#include "sim/registration/object/object_points.h"

#include <algorithm>
#include <cmath>

#include "sim/registration/segments.h"

namespace hydroprint::registration {
namespace {

constexpr double kJump_mm = 12;
constexpr double kMarkerMargin_mm = 10;
constexpr double kStray_mm = 50;      ///< margin around a marker that may be displaced
constexpr double kSpeckShare = 0.03;  ///< minimum size of a piece, relative to the largest
constexpr std::size_t kSpeckPoints = 40;

bool of_a_marker(const Eigen::Vector3d& p_F, const FilmFrame& frame, const MarkerLayout& layout) {
  for (std::size_t a = 0; a < layout.markers.size(); ++a) {
    const bool is_well = a >= frame.markers.size() || frame.markers[a].used;
    const Eigen::Vector3d p_M = layout.markers[a].X_FM.inverse() * p_F;
    const double half = layout.width_mm / 2 + (is_well ? kMarkerMargin_mm : kStray_mm);
    const double top = std::max(layout.height_mm, is_well ? 0 : layout.width_mm);
    if (p_M.head<2>().cwiseAbs().maxCoeff() < half && p_M.z() < top + kMarkerMargin_mm) return true;
  }
  return false;
}

bool may_be_object(const Eigen::Vector3d& p_F, const FilmFrame& frame, const Surroundings& s) {
  if (p_F.z() < s.clear_mm) return false;
  if (std::abs(p_F.x()) > s.reach_mm.x() || std::abs(p_F.y()) > s.reach_mm.y()) return false;
  if (p_F.z() > s.gripper_from_mm && (p_F.head<2>() - s.gripper_mm).norm() < s.gripper_radius_mm)
    return false;
  return !of_a_marker(p_F, frame, s.layout);
}

}  // namespace

ObjectPoints object_points(const scan::Cloud& cloud, const FilmFrame& frame,
                           const Surroundings& surroundings) {
  const Pose X_FC = frame.X_CF().inverse();
  std::vector<bool> chosen(cloud.points.size());
  for (std::size_t i = 0; i < chosen.size(); ++i)
    chosen[i] = may_be_object(X_FC * cloud.points[i].point_mm, frame, surroundings);
  ObjectPoints out;
  const auto pieces = segments(cloud, chosen, kJump_mm);
  for (const auto& piece : pieces) {
    if (piece.size() < kSpeckPoints ||
        static_cast<double>(piece.size()) < kSpeckShare * static_cast<double>(pieces[0].size()))
      break;
    for (const int i : piece) out.all.push_back(cloud.points[static_cast<std::size_t>(i)]);
    out.largest = std::max(out.largest, piece.size());
  }
  return out;
}

}  // namespace hydroprint::registration
