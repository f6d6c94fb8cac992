#include "sim/plan/blend.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "sim/plan/borders.h"
#include "sim/plan/facets.h"

namespace hydroprint::plan {
namespace {

constexpr std::size_t kPointsPerTask = 512;

/// A field to compute: its sources and the triangles that its paths may enter.
struct FieldTask {
  std::vector<Source> sources;
  std::vector<char> open;
};

/// The border of one dip's region, seen from outside.
FieldTask region_border(const Facets& facets, const Borders& borders, const Fragments& fragments,
                        int dip) {
  FieldTask task;
  const auto is_own = [&](int fragment) {
    return fragments.all[static_cast<std::size_t>(fragment)].dip == dip;
  };
  for (const auto& border : borders.inner) {
    if (is_own(border.fragment) == is_own(border.other)) continue;
    const int triangle = fragments.all[static_cast<std::size_t>(border.fragment)].triangle;
    task.sources.push_back({triangle, border.ends});
  }
  for (const auto& border : borders.across) {
    const auto along = borders.fragments(border, facets);
    if (std::none_of(along.begin(), along.end(), is_own)) continue;
    const auto sides = facets.edges().sides(border.edge);
    for (std::size_t i = 0; i < sides.size(); ++i) {
      if (is_own(along[i])) continue;
      const auto end = [&](double fraction) {
        return on_side(sides[i], fraction_on(sides[i], fraction, facets));
      };
      task.sources.push_back({sides[i] / 3, {end(border.from), end(border.to)}});
    }
  }
  task.open.assign(facets.size(), 0);
  for (const auto& fragment : fragments.all) {
    if (fragment.dip != dip) task.open[static_cast<std::size_t>(fragment.triangle)] = 1;
  }
  return task;
}

/// The edges of the part that one dip reaches beyond which another dip reaches, seen from inside.
FieldTask reach_border(const Facets& facets, const Fragments& fragments, int dip) {
  FieldTask task;
  task.open.resize(facets.size());
  for (std::size_t t = 0; t < facets.size(); ++t)
    task.open[t] = fragments.reaches(dip, static_cast<int>(t)) ? 1 : 0;
  const auto is_open = [&](int side) { return task.open[static_cast<std::size_t>(side / 3)] != 0; };
  for (std::size_t e = 0; e < facets.edges().size(); ++e) {
    const auto sides = facets.edges().sides(e);
    const bool ends = std::any_of(sides.begin(), sides.end(), [&](int side) {
      return !is_open(side) && fragments.reach[static_cast<std::size_t>(side / 3)] != 0;
    });
    if (!ends) continue;
    for (const int side : sides) {
      if (is_open(side)) task.sources.push_back({side / 3, {on_side(side, 0), on_side(side, 1)}});
    }
  }
  return task;
}

}  // namespace

Result<BlendWeights> BlendWeights::create(const mesh::Surface& surface, const Regions& regions,
                                          double blend_mm, const Context& context) {
  if (!(blend_mm > 0) || !std::isfinite(blend_mm))
    return fail(Code::kInvalidArgument,
                fmt::format("blend width of {} mm; use more than 0 mm.", blend_mm));
  BlendWeights weights;
  weights.blend_mm_ = blend_mm;
  weights.fragments_ = regions.fragments;
  const auto dips = static_cast<std::size_t>(regions.dips);
  weights.distance_.resize(dips);
  weights.reach_.resize(dips);
  const auto facets = std::make_shared<const Facets>(surface);
  const Borders borders = find_borders(*facets, regions.fragments);
  const auto compute = [&](std::size_t i) -> Status {
    const int dip = static_cast<int>(i / 2) + 1;
    const bool is_reach = i % 2 != 0;
    const FieldTask task = is_reach ? reach_border(*facets, regions.fragments, dip)
                                    : region_border(*facets, borders, regions.fragments, dip);
    DistanceField& field = (is_reach ? weights.reach_ : weights.distance_)[i / 2];
    HP_ASSIGN_OR_RETURN(field,
                        DistanceField::create(facets, task.sources, task.open, blend_mm, context));
    return {};
  };
  HP_RETURN_IF_ERROR(parallel_for(context, "blend", 2 * dips, compute));
  for (std::size_t t = 0; t < facets->size(); ++t)
    weights.only_dip_.push_back(weights.find_only_dip(static_cast<int>(t)));
  return weights;
}

/// Returns the dip that prints the whole triangle alone; 0 if no dip does, -1 if several may.
int BlendWeights::find_only_dip(int triangle) const {
  const auto fragments = fragments_.of_triangle(triangle);
  const int own = fragments.front().dip;
  if (own == 0) return 0;
  const auto is_own = [&](const Fragment& fragment) { return fragment.dip == own; };
  if (!std::all_of(fragments.begin(), fragments.end(), is_own)) return -1;
  for (int dip = 1; dip <= dips(); ++dip) {
    if (dip == own || !fragments_.reaches(dip, triangle)) continue;
    if (distance_[static_cast<std::size_t>(dip - 1)].comes_to(triangle)) return -1;
  }
  return own;
}

double BlendWeights::of_dip(int dip, int triangle, const Eigen::Vector3d& barycentric) const {
  const int only = only_dip_[static_cast<std::size_t>(triangle)];
  if (only >= 0) return only == dip && only != 0 ? 1 : 0;
  return at(triangle, barycentric)[static_cast<std::size_t>(dip - 1)];
}

std::vector<double> BlendWeights::at(int triangle, const Eigen::Vector3d& barycentric) const {
  std::vector<double> weights(distance_.size(), 0);
  const int own = fragments_.all[fragments_.find(triangle, barycentric)].dip;
  if (own == 0) return weights;
  double sum = 0;
  for (int dip = 1; dip <= dips(); ++dip) {
    if (!fragments_.reaches(dip, triangle)) continue;
    const auto k = static_cast<std::size_t>(dip - 1);
    double weight = 1;
    if (dip != own) weight = std::max(0.0, 1 - distance_[k].at(triangle, barycentric) / blend_mm_);
    if (weight > 0) weight *= std::min(1.0, reach_[k].at(triangle, barycentric) / blend_mm_);
    weights[k] = weight;
    sum += weight;
  }
  if (sum > 0) {
    for (double& weight : weights) weight /= sum;
  } else {
    weights[static_cast<std::size_t>(own - 1)] = 1;
  }
  return weights;
}

Result<std::vector<std::vector<double>>> BlendWeights::at_points(const mesh::Surface& surface,
                                                                 const Context& context) const {
  const std::size_t points = surface.points.size();
  const std::vector<int> corner_at = reached_corners(surface, fragments_);
  std::vector<std::vector<double>> weights(distance_.size(), std::vector<double>(points, 0));
  const std::size_t tasks = (points + kPointsPerTask - 1) / kPointsPerTask;
  HP_RETURN_IF_ERROR(parallel_for(context, "blend weights", tasks, [&](std::size_t task) -> Status {
    const std::size_t end = std::min((task + 1) * kPointsPerTask, points);
    for (std::size_t p = task * kPointsPerTask; p < end; ++p) {
      const int corner = corner_at[p];
      if (corner < 0) continue;
      const auto at_point = at(corner / 3, Eigen::Vector3d::Unit(corner % 3));
      for (std::size_t k = 0; k < at_point.size(); ++k) weights[k][p] = at_point[k];
    }
    return {};
  }));
  return weights;
}

}  // namespace hydroprint::plan
