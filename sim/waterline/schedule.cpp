#include "sim/waterline/schedule.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/base/check.h"
#include "sim/waterline/level_events.h"

namespace hydroprint::waterline {
namespace {

constexpr int kBins = 8192;
/// Corner normals with a smaller cosine between them make a crease.
constexpr double kCreaseCosine = 0.8;
/// Factor by which steps are shortened at creases. Across an upright crease, the direction of eq.
/// (1) jumps, and with it the film's velocity.
constexpr double kCreaseSteps = 2;
/// Steps are shortened at radii of curvature below kBend_mm. Radii below kSharpest_mm count as
/// kSharpest_mm.
constexpr double kBend_mm = 20, kSharpest_mm = 1;

struct Triangle {
  double low_mm, high_mm, area_mm2, sine, cosine;
};

Triangle measure(const Body& body, const Eigen::Vector3i& t) {
  const Eigen::Vector3d& a = body.points_mm[t[0]];
  const Eigen::Vector3d& b = body.points_mm[t[1]];
  const Eigen::Vector3d& c = body.points_mm[t[2]];
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const double length = std::max(normal.norm(), 1e-300);
  const auto [low, high] = std::minmax({a.z(), b.z(), c.z()});
  return {low, high, 0.5 * length, normal.head<2>().norm() / length, -normal.z() / length};
}

/// Properties of the surface in each bin of depth.
struct Bins {
  std::vector<double> wetted_mm2;  ///< wetted surface, weighted
  std::vector<double> length_mm;   ///< mean waterline length
  std::vector<double> smallness;   ///< mean smallness() on the waterline, by vertical curvature
  std::vector<char> has_crease;    ///< whether the waterline crosses creases
};

/// Returns the weight of surface at the angle theta with this cosine. Near level faces the film
/// hardly moves (u = tan(theta / 2)), so steps may be longer there.
double weight(double cosine) {
  const double tangent = std::sqrt(std::max(0.0, 1 - cosine) / std::max(1e-12, 1 + cosine));
  return std::clamp(2 * tangent, 0.3, 1.0);
}

/// Returns the factor for the swept width where a radius is smaller than the one for which the
/// steps are designed. The factor keeps the error in mm about the same (ScheduleOptions::swept_mm).
double smallness(double radius_mm, double meant_for_mm) {
  return std::min(1.0, std::pow(radius_mm / meant_for_mm, 2.0 / 3));
}

/// Returns the smallness of a whole body: that of a sphere with the same surface area.
double smallness(const Body& body) {
  double area_mm2 = 0;
  for (const Eigen::Vector3i& t : body.triangles) area_mm2 += measure(body, t).area_mm2;
  return smallness(std::sqrt(area_mm2 / (4 * std::numbers::pi)), ScheduleOptions::kLarge_mm);
}

/// Returns the radius of curvature in the uphill direction on a triangle, from the change of theta
/// between the corners' normals. Infinite if theta does not change.
double bend_mm(const Body& body, std::size_t triangle) {
  const Eigen::Vector3i& t = body.triangles[triangle];
  const auto point = [&](int i) { return body.points_mm[t[i % 3]]; };
  const Eigen::Vector3d normal = (point(1) - point(0)).cross(point(2) - point(0));
  const Eigen::Vector3d n = normal.normalized();
  const Eigen::Vector3d uphill = (Eigen::Vector3d::UnitZ() - n.z() * n).normalized();
  double per_mm = 0;
  for (int i = 0; i < 3; ++i) {
    const double theta_rad =
        std::acos(std::clamp(-body.corner_normals[triangle][i].z(), -1.0, 1.0));
    per_mm += theta_rad * uphill.dot(n.cross(point(i + 2) - point(i + 1))) / normal.norm();
  }
  const double radius_mm = 1 / std::abs(per_mm);
  return std::isfinite(per_mm) ? std::max(radius_mm, kSharpest_mm)
                               : std::numeric_limits<double>::infinity();
}

/// Returns for each point whether it lies on a crease.
std::vector<char> crease_points(const Body& body) {
  std::vector<char> is_crease(body.points_mm.size(), 0), found(body.points_mm.size(), 0);
  std::vector<Eigen::Vector3d> first(body.points_mm.size());
  for (std::size_t t = 0; t < body.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const int v = body.triangles[t][i];
      const Eigen::Vector3d& normal = body.corner_normals[t][i];
      if (found[v] == 0) {
        first[v] = normal;
        found[v] = 1;
      } else if (first[v].dot(normal) < kCreaseCosine) {
        is_crease[v] = 1;
      }
    }
  }
  return is_crease;
}

Bins collect(const Body& body, double shelf_slope_rad) {
  const double bin_mm = body.height_mm / kBins;
  // Each triangle adds differences of density at the two ends of its range, with the end bins
  // partly filled. A running sum then gives the value of each bin.
  std::vector<double> area(kBins + 2, 0), length(kBins + 2, 0), small(kBins + 2, 0),
      crease(kBins + 2, 0);
  const std::vector<char> is_crease = crease_points(body);
  const auto spread = [&](std::vector<double>& bins, double low, double high, double density) {
    const auto step_up = [&](double z, double rise) {  // adds density above z, as bin averages
      const double at = std::clamp(z / bin_mm, 0.0, static_cast<double>(kBins));
      const int bin = static_cast<int>(at);
      const double inside = 1 - (at - bin);
      bins[bin] += rise * inside;
      bins[bin + 1] += rise * (1 - inside);
    };
    step_up(low, density);
    step_up(high, -density);
  };
  for (std::size_t i = 0; i < body.triangles.size(); ++i) {
    const Eigen::Vector3i& t = body.triangles[i];
    const Triangle m = measure(body, t);
    if (m.sine < shelf_slope_rad) continue;
    const double range_mm = std::max(m.high_mm - m.low_mm, 1e-9);
    const double length_mm = m.area_mm2 * m.sine / range_mm;
    spread(area, m.low_mm, m.high_mm, weight(m.cosine) * m.area_mm2 / range_mm);
    spread(length, m.low_mm, m.high_mm, length_mm);
    spread(small, m.low_mm, m.high_mm, length_mm * smallness(bend_mm(body, i), kBend_mm));
    if (is_crease[t[0]] + is_crease[t[1]] + is_crease[t[2]] > 1) {
      spread(crease, m.low_mm, m.high_mm, 1);
    }
  }
  Bins bins{std::vector<double>(kBins), std::vector<double>(kBins), std::vector<double>(kBins, 1),
            std::vector<char>(kBins)};
  double running_area = 0, running_length = 0, running_small = 0, running_crease = 0;
  for (int b = 0; b < kBins; ++b) {
    running_area += area[b];
    running_length += length[b];
    running_small += small[b];
    running_crease += crease[b];
    bins.has_crease[b] = running_crease > 1e-6;
    bins.wetted_mm2[b] = std::max(0.0, running_area) * bin_mm;
    bins.length_mm[b] = std::max(0.0, running_length);
    if (running_length > 1e-6) bins.smallness[b] = running_small / running_length;
  }
  return bins;
}

/// Returns the immersions that divide the swept surface evenly. Their distance is multiplied by
/// `widening` where they would be more than `most`.
std::vector<double> divide_swept_surface(const Body& body, const ScheduleOptions& options,
                                         std::size_t most, double& widening) {
  const double bin_mm = body.height_mm / kBins;
  const Bins bins = collect(body, options.shelf_slope_rad);
  const double small = smallness(body);
  std::vector<double> steps(kBins, 0);
  double sum = 0;
  for (int b = 0; b < kBins; ++b) {
    if (bins.length_mm[b] <= 0) continue;
    const double swept_mm = options.swept_mm * std::min(small, bins.smallness[b]);
    const double width_mm = bins.has_crease[b] != 0 ? swept_mm / kCreaseSteps : swept_mm;
    steps[b] = std::min(bins.wetted_mm2[b] / (width_mm * bins.length_mm[b]), 4.0);
    sum += steps[b];
  }
  widening = std::max(1.0, sum / static_cast<double>(most));
  std::vector<double> depths;
  double done = 0, next = 1;
  for (int b = 0; b < kBins; ++b) {
    const double here = steps[b] / widening;
    while (done + here >= next) {
      depths.push_back((b + (next - done) / here) * bin_mm);
      ++next;
    }
    done += here;
  }
  return depths;
}

/// Returns true if there are edges, but no faces, within a distance of a level.
bool is_edge(const std::vector<LevelEvent>& events, double level_mm, double within_mm) {
  const auto is_there = [&](const LevelEvent& event) {
    return std::abs(event.level_mm - level_mm) <= within_mm;
  };
  const auto first = std::ranges::find_if(events, is_there);  // faces come first
  return first != events.end() && !first->is_face;
}

}  // namespace

Schedule schedule(const Body& body, double depth_mm, const ScheduleOptions& options) {
  HP_CHECK(depth_mm >= 0);
  HP_CHECK(options.event_gap_mm > 0);
  const double gap_mm = options.event_gap_mm;
  Schedule out;
  std::vector<double> depths = divide_swept_surface(body, options, options.most / 2, out.widening);
  // A quarter of the limit remains for changes of the topology.
  const std::size_t most_events = (options.most - options.most / 4 - depths.size()) / 2;
  const std::vector<LevelEvent> events = level_events(body, options.shelf_slope_rad);
  const double edge_gap_mm = std::max(gap_mm, std::min(options.edge_gap_mm, 0.01 * depth_mm));
  for (std::size_t i = 0; i < events.size(); ++i) {
    const LevelEvent& event = events[i];
    if (event.level_mm < gap_mm || event.level_mm > depth_mm - gap_mm) continue;
    if (i < most_events) {
      depths.push_back(event.level_mm - gap_mm);
      depths.push_back(event.level_mm + (event.is_face ? gap_mm : edge_gap_mm));
    } else {
      out.left_out_mm.push_back(event.level_mm);
    }
  }
  depths.insert(depths.end(), options.added_mm.begin(), options.added_mm.end());
  const auto gap_at = [&](double level_mm) {
    return is_edge(events, level_mm, gap_mm) ? edge_gap_mm : gap_mm;
  };
  const double first_mm = gap_at(0), last_mm = depth_mm - gap_at(depth_mm);
  std::erase_if(depths, [&](double d) { return d < first_mm || d > last_mm; });
  depths.push_back(first_mm);
  depths.push_back(last_mm);
  std::sort(depths.begin(), depths.end());
  std::vector<double>& kept = out.depths_mm;
  for (const double d : depths) {
    const bool in_range = d >= 0.5 * gap_mm && d <= depth_mm - 0.5 * gap_mm;
    if (in_range && (kept.empty() || d - kept.back() > 0.5 * gap_mm)) kept.push_back(d);
  }
  return out;
}

}  // namespace hydroprint::waterline
