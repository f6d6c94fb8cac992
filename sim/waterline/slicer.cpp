#include "sim/waterline/slicer.h"

#include <algorithm>
#include <cmath>

#include "sim/waterline/contours.h"

namespace hydroprint::waterline {
namespace {

constexpr int kBins = 4000;

std::uint64_t edge_key(int a, int b) {
  const auto [low, high] = std::minmax(a, b);
  return static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint32_t>(high);
}

struct Crossing {
  Eigen::Vector2d point_mm;
  Eigen::Vector3d normal;
  std::uint64_t edge;
};

/// Returns the point at which the edge from corner i to corner j of triangle t crosses the level.
Crossing cross(const Body& body, int t, int i, int j, double level_mm) {
  const int vi = body.triangles[t][i];
  const int vj = body.triangles[t][j];
  // Always computed from the lower index, so that both triangles at an edge get the same result.
  const bool swap = vi > vj;
  const Eigen::Vector3d& p = body.points_mm[swap ? vj : vi];
  const Eigen::Vector3d& q = body.points_mm[swap ? vi : vj];
  const double s = (level_mm - p.z()) / (q.z() - p.z());
  const auto& normals = body.corner_normals[t];
  const double from_i = swap ? 1 - s : s;
  return {(p + s * (q - p)).head<2>(),
          ((1 - from_i) * normals[i] + from_i * normals[j]).normalized(), edge_key(vi, vj)};
}

}  // namespace

Slicer::Slicer(const Body& body) : body_(&body) {
  bins_per_mm_ = kBins / std::max(body.height_mm, 1e-3);
  const auto bin_of = [&](double z) {
    return std::clamp(static_cast<int>(std::floor(z * bins_per_mm_)), 0, kBins - 1);
  };
  const auto range_of = [&](const Eigen::Vector3i& t) {
    const auto [low, high] =
        std::minmax({body.points_mm[t[0]].z(), body.points_mm[t[1]].z(), body.points_mm[t[2]].z()});
    return std::pair{bin_of(low), bin_of(high)};
  };
  bin_start_.assign(kBins + 1, 0);
  for (const Eigen::Vector3i& t : body.triangles) {
    const auto [first, last] = range_of(t);
    for (int b = first; b <= last; ++b) ++bin_start_[b + 1];
  }
  for (int b = 0; b < kBins; ++b) bin_start_[b + 1] += bin_start_[b];
  bin_triangles_.resize(bin_start_.back());
  std::vector<int> next(bin_start_.begin(), bin_start_.end() - 1);
  for (int t = 0; t < static_cast<int>(body.triangles.size()); ++t) {
    const auto [first, last] = range_of(body.triangles[t]);
    for (int b = first; b <= last; ++b) bin_triangles_[next[b]++] = t;
  }
}

std::vector<Contour> Slicer::cut(double immersion_mm) const {
  const int bin =
      std::clamp(static_cast<int>(std::floor(immersion_mm * bins_per_mm_)), 0, kBins - 1);
  std::vector<CutSegment> cuts;
  for (int at = bin_start_[bin]; at < bin_start_[bin + 1]; ++at) {
    const int t = bin_triangles_[at];
    const Eigen::Vector3i& corners = body_->triangles[t];
    const auto is_wet = [&](int i) { return body_->points_mm[corners[i]].z() < immersion_mm; };
    const int wet = is_wet(0) + is_wet(1) + is_wet(2);
    if (wet == 0 || wet == 3) continue;
    // The corner that is alone on its side of the water.
    const int lone = is_wet(0) == is_wet(1) ? 2 : (is_wet(0) == is_wet(2) ? 1 : 0);
    const Crossing c = cross(*body_, t, lone, (lone + 1) % 3, immersion_mm);
    const Crossing d = cross(*body_, t, lone, (lone + 2) % 3, immersion_mm);
    // Corners are counter-clockwise as seen from outside. If the lone corner is dry, the cut starts
    // on its edge to the next corner and ends on its edge to the previous corner, so that the solid
    // is on the left. If it is wet, the cut is reversed.
    const Crossing& from = wet == 1 ? d : c;
    const Crossing& to = wet == 1 ? c : d;
    cuts.push_back(
        {{from.point_mm, to.point_mm, pull(from.normal), pull(to.normal)}, from.edge, to.edge});
  }
  return join(cuts);
}

}  // namespace hydroprint::waterline
