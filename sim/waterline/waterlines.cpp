#include "sim/waterline/waterlines.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/base/check.h"
#include "sim/waterline/air.h"
#include "sim/waterline/slicer.h"

namespace hydroprint::waterline {
namespace {

/// Points within this distance of the film's edge count as having reached it.
constexpr double kEdgeMargin_mm = 0.05;
/// Smaller contours are ignored when deciding where to insert waterlines.
constexpr double kLeastIsland_mm2 = 0.2;

const Motion::Row* row_after(const Motion& motion, double immersion_mm) {
  const auto it =
      std::lower_bound(motion.rows.begin(), motion.rows.end(), immersion_mm,
                       [](const Motion::Row& row, double d) { return row.immersion_mm < d; });
  return it == motion.rows.end() ? nullptr : &*it;
}

std::vector<Contour> contours_at(const Slicer& slicer, const Motion& motion, double immersion_mm) {
  std::vector<Contour> contours = slicer.cut(immersion_mm);
  const Eigen::Vector2d offset = offset_at(motion, immersion_mm);
  const Eigen::Vector2d drift = drift_at(motion, immersion_mm);
  for (Contour& contour : contours) {
    for (Segment& s : contour) {
      s.a_mm += offset;
      s.b_mm += offset;
      s.pull_a += drift;
      s.pull_b += drift;
    }
  }
  return contours;
}

Waterline take(const Slicer& slicer, const Motion& motion, double immersion_mm) {
  const std::vector<Contour> contours = contours_at(slicer, motion, immersion_mm);
  return {immersion_mm, unite(contours), {}, PullIndex(contours)};
}

/// Returns the numbers of outer loops and of holes above a minimum size. They change when the
/// topology changes.
std::array<int, 2> signature(const Waterline& line) {
  std::array<int, 2> count = {0, 0};
  for (const Loop& loop : line.section) {
    if (std::abs(signed_area(loop.points_mm)) >= kLeastIsland_mm2) ++count[loop.is_hole];
  }
  return count;
}

double distance_to(const std::vector<Eigen::Vector2d>& polygon, const Eigen::Vector2d& p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Eigen::Vector2d along = polygon[i] - polygon[j];
    const double t = std::clamp((p - polygon[j]).dot(along) / along.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (polygon[j] + t * along - p).norm());
  }
  return least;
}

bool reaches_edge(const film::Outline& outline, const Waterline& line) {
  for (const Loop& loop : line.section) {
    if (loop.parent >= 0) continue;
    for (const Eigen::Vector2d& p : loop.points_mm) {
      if (!film::contains(outline, p) || distance_to(outline.polygon, p) < kEdgeMargin_mm) {
        return true;
      }
    }
  }
  return false;
}

Status check_first_contact(const Body& body, const film::Outline& outline, const Waterline& first,
                           const Motion& motion) {
  Eigen::Vector2d touch = Eigen::Vector2d::Zero();
  for (const Eigen::Vector3i& triangle : body.triangles) {
    for (const int v : triangle) {
      if (body.points_mm[v].z() > 1e-3) continue;
      touch = body.points_mm[v].head<2>() + offset_at(motion, 0);
      if (film::contains(outline, touch)) return {};
    }
  }
  std::vector<std::vector<Eigen::Vector2d>> solid;
  for (const Loop& loop : first.section) solid.push_back(loop.points_mm);
  if (common_area({outline.polygon}, solid) > 0) return {};
  return fail_field(
      Code::kFailedPrecondition, "pose",
      fmt::format("the object's lowest point, at ({:.1f}, {:.1f}) mm, misses the film {}. Move the "
                  "object over the film, or use a larger film",
                  touch.x(), touch.y(), outline.name),
      ErrorReason::CONTACT_MISSES_FILM);
}

using Curves = std::vector<std::vector<Eigen::Vector2d>>;

/// Returns the curves around regions that are neither film nor solid: holes without film.
Curves dry_curves(const Waterline& line) {
  Curves curves;
  for (std::size_t l = 0; l < line.section.size(); ++l) {
    const Loop& loop = line.section[l];
    if (!line.bounds_film[l] && (loop.is_hole || loop.parent >= 0)) {
      curves.push_back(loop.points_mm);
    }
  }
  return curves;
}

/// Determines which loops bound film, from the previous waterline.
void carry_film(const film::Outline& outline, const Waterline& before, Waterline& line) {
  line.bounds_film.assign(line.section.size(), 0);
  for (std::size_t l = 0; l < line.section.size(); ++l) {
    const Loop& loop = line.section[l];
    if (!loop.is_hole) {
      line.bounds_film[l] = loop.parent < 0 || line.bounds_film[loop.parent];
      continue;
    }
    Curves hole = {loop.points_mm};
    for (const Loop& island : line.section) {
      if (island.parent == static_cast<int>(l)) hole.push_back(island.points_mm);
    }
    const double film_mm2 = common_area(hole, film_curves(outline, before));
    const double dry_mm2 = common_area(hole, dry_curves(before));
    const double hole_mm2 = std::abs(signed_area(loop.points_mm));
    line.bounds_film[l] = film_mm2 > 0.05 * hole_mm2 && film_mm2 > dry_mm2;
  }
}

/// The waterlines of a dip, and where they are too far apart.
struct TakenLines {
  std::vector<Waterline> lines;
  std::vector<Gap> coarse;
};

/// Returns the gaps between waterlines of different topology, widest first.
std::vector<Gap> unresolved_gaps(const std::vector<Waterline>& lines, double least_mm) {
  std::vector<Gap> gaps;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const Gap gap{lines[i - 1].immersion_mm, lines[i].immersion_mm};
    if (gap.width_mm() > least_mm && signature(lines[i]) != signature(lines[i - 1])) {
      gaps.push_back(gap);
    }
  }
  std::ranges::stable_sort(gaps, std::ranges::greater{}, &Gap::width_mm);
  return gaps;
}

/// Computes waterlines at the given immersions, and more where the topology changes between them,
/// until the changes are located or the limit is reached.
Result<TakenLines> take_all(const Slicer& slicer, const Motion& motion,
                            const std::vector<double>& depths, const ScheduleOptions& options,
                            const Context& context) {
  HP_CHECK(std::is_sorted(depths.begin(), depths.end()));
  TakenLines out;
  std::vector<Waterline>& lines = out.lines;
  lines.resize(depths.size());
  HP_RETURN_IF_ERROR(
      parallel_for(context, "waterline", depths.size(), [&](std::size_t i) -> Status {
        lines[i] = take(slicer, motion, depths[i]);
        return {};
      }));
  while (true) {
    out.coarse = unresolved_gaps(lines, 5 * options.event_gap_mm);
    const std::size_t room = options.most - std::min(options.most, lines.size());
    std::vector<Waterline> added(std::min(room, out.coarse.size()));
    if (added.empty()) break;
    HP_RETURN_IF_ERROR(parallel_for(context, {}, added.size(), [&](std::size_t i) -> Status {
      added[i] = take(slicer, motion, out.coarse[i].middle_mm());
      return {};
    }));
    for (Waterline& line : added) lines.push_back(std::move(line));
    std::sort(lines.begin(), lines.end(), [](const Waterline& a, const Waterline& b) {
      return a.immersion_mm < b.immersion_mm;
    });
  }
  return out;
}

/// Truncates the list where the waterline reaches the film's edge, and adds a last waterline just
/// before that.
void stop_at_edge(const Slicer& slicer, const Motion& motion, const film::Outline& outline,
                  Waterlines& waterlines) {
  auto& lines = waterlines.lines;
  const auto first = std::find_if(lines.begin(), lines.end(), [&](const Waterline& line) {
    return reaches_edge(outline, line);
  });
  if (first == lines.end()) return;
  waterlines.stopped_at_edge = true;
  double inside = first == lines.begin() ? 0 : (first - 1)->immersion_mm;
  double beyond = first->immersion_mm;
  lines.erase(first, lines.end());
  Waterline last;
  while (beyond - inside > 1e-3) {
    Waterline middle = take(slicer, motion, 0.5 * (inside + beyond));
    if (reaches_edge(outline, middle)) {
      beyond = middle.immersion_mm;
    } else {
      inside = middle.immersion_mm;
      last = std::move(middle);
    }
  }
  if (last.immersion_mm > 0) lines.push_back(std::move(last));
  waterlines.depth_mm = beyond;
}

/// Computes the waterlines above the end of the dip, for finding the ceilings of holes.
Result<std::vector<Waterline>> take_beyond(const Slicer& slicer, const Body& body, double depth_mm,
                                           const Motion& motion, const ScheduleOptions& options,
                                           const Context& context) {
  std::vector<double> depths = schedule(body, body.height_mm, options).depths_mm;
  depths.erase(depths.begin(), std::upper_bound(depths.begin(), depths.end(), depth_mm));
  std::vector<Waterline> lines(depths.size());
  HP_RETURN_IF_ERROR(parallel_for(context, {}, depths.size(), [&](std::size_t i) -> Status {
    lines[i] = take(slicer, motion, depths[i]);
    return {};
  }));
  return lines;
}

bool has_film_inside(const Waterline& line) {
  for (std::size_t l = 0; l < line.section.size(); ++l) {
    if (line.section[l].is_hole && line.bounds_film[l]) return true;
  }
  return false;
}

/// Takes the film out of holes whose air cannot escape, and away from the loops within them.
void keep_film_out(const std::vector<char>& is_closed, Waterline& line) {
  for (std::size_t l = 0; l < line.section.size(); ++l) {
    const int parent = line.section[l].parent;
    const bool is_island = !line.section[l].is_hole && parent >= 0;
    if (is_closed[l] != 0 || (is_island && line.bounds_film[parent] == 0)) line.bounds_film[l] = 0;
  }
}

/// Finds the film and air that the object encloses, and takes the film out of the air.
Status trap(const Slicer& slicer, const Body& body, const Motion& motion,
            const ScheduleOptions& options, const Context& context, Waterlines& result) {
  std::vector<Waterline>& lines = result.lines;
  if (std::none_of(lines.begin(), lines.end(), has_film_inside)) return {};
  const CrossSection& last = lines.back().section;
  std::vector<Waterline> beyond;
  if (std::any_of(last.begin(), last.end(), [](const Loop& loop) { return loop.is_hole; })) {
    HP_ASSIGN_OR_RETURN(beyond,
                        take_beyond(slicer, body, result.depth_mm, motion, options, context));
  }
  std::vector<const Waterline*> all;
  for (const Waterline& line : lines) all.push_back(&line);
  for (const Waterline& line : beyond) all.push_back(&line);
  const auto section_at = [&](double immersion_mm) {
    if (context.is_cancelled()) return CrossSection{};
    return unite(contours_at(slicer, motion, immersion_mm));
  };
  const auto is_closed = holes_with_trapped_air(all, section_at);
  HP_RETURN_IF_ERROR(check_cancelled(context));
  result.traps = find_traps(all, is_closed, lines.size());
  if (options.air_escapes) return {};
  for (std::size_t k = 0; k < lines.size(); ++k) keep_film_out(is_closed[k], lines[k]);
  return {};
}

}  // namespace

Eigen::Vector2d offset_at(const Motion& motion, double immersion_mm) {
  if (motion.rows.empty()) return Eigen::Vector2d::Zero();
  const Motion::Row* after = row_after(motion, immersion_mm);
  if (after == nullptr) return motion.rows.back().offset_mm;
  if (after == motion.rows.data()) return after->offset_mm;
  const Motion::Row& before = *(after - 1);
  const double span = after->immersion_mm - before.immersion_mm;
  const double t = span > 0 ? (immersion_mm - before.immersion_mm) / span : 1.0;
  return (1 - t) * before.offset_mm + t * after->offset_mm;
}

Eigen::Vector2d drift_at(const Motion& motion, double immersion_mm) {
  const Motion::Row* after = row_after(motion, immersion_mm);
  if (motion.rows.empty() || after == nullptr || after == motion.rows.data()) {
    return Eigen::Vector2d::Zero();
  }
  const Motion::Row& before = *(after - 1);
  const double span = after->immersion_mm - before.immersion_mm;
  if (span <= 0) return Eigen::Vector2d::Zero();
  return (after->offset_mm - before.offset_mm) / span;
}

Curves film_curves(const film::Outline& outline, const Waterline& line) {
  Curves curves = {outline.polygon};
  for (std::size_t l = 0; l < line.section.size(); ++l) {
    if (line.bounds_film[l]) curves.push_back(line.section[l].points_mm);
  }
  return curves;
}

Result<Waterlines> take_waterlines(const Body& body, const film::Outline& outline, double depth_mm,
                                   const Motion& motion, const ScheduleOptions& options,
                                   const Context& context) {
  const Slicer slicer(body);
  Waterlines result;
  result.depth_mm = std::min(depth_mm, body.height_mm);
  HP_RETURN_IF_ERROR(
      check_first_contact(body, outline, take(slicer, motion, options.event_gap_mm), motion));
  const Schedule planned = schedule(body, result.depth_mm, options);
  HP_ASSIGN_OR_RETURN(TakenLines taken,
                      take_all(slicer, motion, planned.depths_mm, options, context));
  result.lines = std::move(taken.lines);
  result.coarse = {planned.widening, planned.left_out_mm, std::move(taken.coarse)};
  stop_at_edge(slicer, motion, outline, result);
  std::erase_if(result.coarse.unresolved,
                [&](const Gap& gap) { return gap.from_mm >= result.depth_mm; });
  const Waterline rest;
  for (std::size_t i = 0; i < result.lines.size(); ++i) {
    carry_film(outline, i == 0 ? rest : result.lines[i - 1], result.lines[i]);
  }
  HP_RETURN_IF_ERROR(trap(slicer, body, motion, options, context, result));
  return result;
}

}  // namespace hydroprint::waterline
