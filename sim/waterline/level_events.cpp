#include "sim/waterline/level_events.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace hydroprint::waterline {
namespace {

constexpr double kLeastShelf_mm2 = 0.5;
constexpr double kLeastRim_mm = 5;
constexpr double kSameLevel_mm = 1e-3;

/// A level, and the area or length that lies there.
struct LevelSize {
  double level_mm = 0;
  double size = 0;
};

/// Unites levels within kSameLevel_mm, and returns those with at least `least`, largest first.
std::vector<LevelSize> gather(std::vector<LevelSize> parts, double least) {
  std::ranges::sort(parts, {}, &LevelSize::level_mm);
  std::vector<LevelSize> levels;
  for (std::size_t i = 0; i < parts.size();) {
    LevelSize level{parts[i].level_mm, 0};
    for (; i < parts.size() && parts[i].level_mm - level.level_mm < kSameLevel_mm; ++i) {
      level.size += parts[i].size;
    }
    if (level.size >= least) levels.push_back(level);
  }
  std::ranges::stable_sort(levels, std::ranges::greater{}, &LevelSize::size);
  return levels;
}

/// Returns the levels of level faces.
std::vector<LevelSize> shelves(const Body& body, double shelf_slope_rad) {
  std::vector<LevelSize> faces;
  for (const Eigen::Vector3i& t : body.triangles) {
    const Eigen::Vector3d& a = body.points_mm[t[0]];
    const Eigen::Vector3d& b = body.points_mm[t[1]];
    const Eigen::Vector3d& c = body.points_mm[t[2]];
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    if (normal.head<2>().norm() >= shelf_slope_rad * std::max(normal.norm(), 1e-300)) continue;
    const auto [low, high] = std::minmax({a.z(), b.z(), c.z()});
    faces.push_back({0.5 * (low + high), 0.5 * normal.norm()});
  }
  return gather(std::move(faces), kLeastShelf_mm2);
}

/// Returns the levels of edges that are creases.
std::vector<LevelSize> rims(const Body& body) {
  struct Side {
    Eigen::Vector3d normal;
    bool found = false;
  };
  std::unordered_map<std::uint64_t, Side> sides;
  std::vector<LevelSize> creases;
  for (std::size_t t = 0; t < body.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const int a = body.triangles[t][i];
      const int b = body.triangles[t][(i + 1) % 3];
      const Eigen::Vector3d& p = body.points_mm[a];
      const Eigen::Vector3d& q = body.points_mm[b];
      if (std::abs(p.z() - q.z()) > 1e-3) continue;
      const auto [low, high] = std::minmax(a, b);
      Side& side = sides[static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint32_t>(high)];
      const Eigen::Vector3d& normal = body.corner_normals[t][a == low ? i : (i + 1) % 3];
      if (!side.found) {
        side = {normal, true};
      } else if (side.normal.dot(normal) < 0.9) {
        creases.push_back({p.z(), (p - q).norm()});
      }
    }
  }
  return gather(std::move(creases), kLeastRim_mm);
}

}  // namespace

std::vector<LevelEvent> level_events(const Body& body, double shelf_slope_rad) {
  std::vector<LevelEvent> events;
  for (const LevelSize& shelf : shelves(body, shelf_slope_rad)) {
    events.push_back({shelf.level_mm, true});
  }
  std::vector<double> faces;
  for (const LevelEvent& event : events) faces.push_back(event.level_mm);
  std::ranges::sort(faces);
  for (const LevelSize& rim : rims(body)) {
    const auto next = std::ranges::lower_bound(faces, rim.level_mm - kSameLevel_mm);
    const bool is_of_face = next != faces.end() && *next < rim.level_mm + kSameLevel_mm;
    if (!is_of_face) events.push_back({rim.level_mm, false});
  }
  return events;
}

}  // namespace hydroprint::waterline
