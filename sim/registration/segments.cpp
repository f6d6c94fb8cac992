#include "sim/registration/segments.h"

#include <algorithm>

#include "sim/base/check.h"

namespace hydroprint::registration {
namespace {

constexpr int kReach_px = 2;  ///< more than 1 because the next pixel may lack a depth

}  // namespace

std::vector<std::vector<int>> segments(const scan::Cloud& cloud, const std::vector<bool>& chosen,
                                       double jump_mm) {
  HP_CHECK(chosen.size() == cloud.points.size());
  std::vector<bool> taken(cloud.points.size());
  std::vector<std::vector<int>> out;
  const auto grow = [&](int seed) {
    std::vector<int> piece{seed};
    taken[static_cast<std::size_t>(seed)] = true;
    for (std::size_t next = 0; next < piece.size(); ++next) {
      const auto& from = cloud.points[static_cast<std::size_t>(piece[next])];
      for (int dv = -kReach_px; dv <= kReach_px; ++dv) {
        for (int du = -kReach_px; du <= kReach_px; ++du) {
          const auto* to = cloud.at(from.u + du, from.v + dv);
          if (to == nullptr) continue;
          const auto i = static_cast<std::size_t>(to - cloud.points.data());
          if (taken[i] || !chosen[i]) continue;
          if ((to->point_mm - from.point_mm).norm() > jump_mm) continue;
          taken[i] = true;
          piece.push_back(static_cast<int>(i));
        }
      }
    }
    return piece;
  };
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
    if (chosen[i] && !taken[i]) out.push_back(grow(static_cast<int>(i)));
  std::stable_sort(out.begin(), out.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return out;
}

}  // namespace hydroprint::registration
