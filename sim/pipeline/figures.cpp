#include "sim/pipeline/figures.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "sim/base/number_text.h"
#include "sim/waterline/body.h"

namespace hydroprint::pipeline {
namespace {

constexpr double kStokesStretch = 1.3;  ///< limit in section 4.4: 0.3 beyond the rest length

/// A sheet that still moves by more than this in the last sweep causes a warning: about a pixel at
/// 300 dpi.
constexpr double kUnsettled_mm = 0.08;

struct Face {
  double area_mm2;
  double theta_rad;  ///< contact angle
};

Face face_of(const waterline::Body& body, std::size_t t) {
  const Eigen::Vector3i& v = body.triangles[t];
  const Eigen::Vector3d& a = body.points_mm[v[0]];
  const Eigen::Vector3d normal = (body.points_mm[v[1]] - a).cross(body.points_mm[v[2]] - a);
  const double length = normal.norm();
  return {0.5 * length, length > 0 ? std::acos(std::clamp(-normal.z() / length, -1.0, 1.0)) : 0};
}

/// Returns the figures that do not depend on where the film lands.
DipFigures figures_of_pass(const StokesPass& pass) {
  DipFigures figures;
  figures.depth_mm = pass.stokes.depth_mm;
  figures.stopped_at_edge = pass.stopped_at_edge;
  figures.traps = pass.traps;
  for (waterline::Trap& trap : figures.traps) trap.air.clear();
  figures.coarse = pass.coarse;
  figures.sections = pass.sections;
  figures.sections_off = pass.sections_off;
  figures.passed_over_mm = pass.passed_over_mm;
  figures.steps = static_cast<int>(pass.stokes.fields.size());
  for (const velocity::VelocityField& field : pass.stokes.fields) {
    const auto vertices = static_cast<int>(field.mesh().vertices_mm.size());
    const auto triangles = static_cast<int>(field.mesh().triangles.size());
    figures.film_vertices_max = std::max(figures.film_vertices_max, vertices);
    figures.film_triangles_max = std::max(figures.film_triangles_max, triangles);
  }
  return figures;
}

/// Returns for each triangle whether film reaches all of it: its corners are outside other parts
/// and have film points.
std::vector<char> triangles_with_film(const mesh::Surface& surface, const flow::SurfaceMap& map) {
  std::vector<char> out(surface.triangles.size(), 1);
  for (std::size_t t = 0; t < out.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int v = surface.triangles[t][k];
      if (surface.is_inner(t, k) || std::isnan(map.film_mm[v].x())) out[t] = 0;
    }
  }
  return out;
}

/// Returns the FaceFlags of a point: all except kClamped and kTrappedAir.
unsigned point_flags(const flow::SurfaceMap& map, int v, const film::Profile& profile) {
  if (std::isnan(map.film_mm[v].x())) return kNotReached;
  unsigned out = 0;
  if (!map.error_mm.empty() && std::isinf(map.error_mm[v])) out |= kNoAnswer;
  if (map.least_stretch[v] < profile.wrinkle_stretch) out |= kWrinkled;
  if (map.stretch[v] > profile.tear_stretch) out |= kTorn;
  return out;
}

/// Distances in front of a triangle at which trapped air is looked for. The nearer point may lie in
/// a wall at the neighbouring waterlines, the farther one beyond a narrow gap.
constexpr std::array<double, 2> kInFront_mm = {0.05, 0.3};

/// Returns whether there is trapped air in front of the middle of a triangle.
bool faces_air(const StokesPass& pass, std::size_t t, const waterline::Motion& motion) {
  const Eigen::Vector3i& v = pass.body.triangles[t];
  const std::vector<Eigen::Vector3d>& points = pass.body.points_mm;
  const Eigen::Vector3d middle = (points[v[0]] + points[v[1]] + points[v[2]]) / 3;
  const Eigen::Vector3d normal =
      (points[v[1]] - points[v[0]]).cross(points[v[2]] - points[v[0]]).normalized();
  return std::ranges::any_of(kInFront_mm, [&](double distance_mm) {
    Eigen::Vector3d point = middle + distance_mm * normal;
    point.head<2>() += waterline::offset_at(motion, point.z());
    return std::ranges::any_of(
        pass.traps, [&](const waterline::Trap& trap) { return waterline::is_in_air(trap, point); });
  });
}

/// Areas of the surface and of parts of it, mm2.
struct Shares {
  double total = 0, reached = 0, clamped = 0, wrinkled = 0, torn = 0;
};

void measure_stretch(const flow::SurfaceMap& map, const std::vector<char>& is_measured,
                     DipFigures& figures) {
  figures.stretch_p50 = figures.stretch_p95 = figures.stretch_max = 0;
  std::vector<double> stretch;
  for (std::size_t v = 0; v < map.stretch.size(); ++v) {
    if (std::isfinite(map.stretch[v]) && is_measured[v] != 0) stretch.push_back(map.stretch[v]);
  }
  if (stretch.empty()) return;
  std::sort(stretch.begin(), stretch.end());
  const auto quantile = [&](double q) {
    return stretch[static_cast<std::size_t>(q * static_cast<double>(stretch.size() - 1))];
  };
  figures.stretch_p50 = quantile(0.5);
  figures.stretch_p95 = quantile(0.95);
  figures.stretch_max = stretch.back();
}

/// Sets the stated error of the counted points with film.
void measure_error(const flow::SurfaceMap& map, const std::vector<char>& counted,
                   const DipOptions& options, DipFigures& figures) {
  figures.error.reset();
  std::vector<double> errors;
  double worst_mm = 0;
  for (std::size_t v = 0; v < map.error_mm.size(); ++v) {
    if (counted[v] == 0 || std::isnan(map.error_mm[v])) continue;
    errors.push_back(map.error_mm[v]);
    if (map.error_mm[v] <= worst_mm) continue;
    worst_mm = map.error_mm[v];
    figures.worst_error_immersion_mm = map.contact_time_s[v] * options.dip_speed_mm_per_s;
  }
  if (errors.empty()) return;
  std::ranges::sort(errors);
  const auto count = static_cast<double>(errors.size());
  const auto share_above = [&](double limit_mm) {
    return static_cast<double>(errors.end() - std::ranges::upper_bound(errors, limit_mm)) / count;
  };
  const double no_bound_share = share_above(std::numeric_limits<double>::max());
  const auto quantile = [&](double q) {
    const double bounded = std::round((1 - no_bound_share) * count);
    return bounded < 1 ? HUGE_VAL : errors[static_cast<std::size_t>(q * (bounded - 1))];
  };
  figures.error =
      MapError{quantile(0.5), quantile(0.95), share_above(options.map.pixel_mm), no_bound_share,
               options.tolerance_mm ? share_above(*options.tolerance_mm) : 0};
}

Place at_immersion(double immersion_mm) { return {AtImmersion{immersion_mm}}; }

/// Returns the place of a trap or a level face.
template <class Found>
Place where_of(const Found& found) {
  return {FilmPoint{found.place_mm.x(), found.place_mm.y(), found.immersion_mm}};
}

std::string and_others(std::ptrdiff_t others) {
  return others > 0 ? fmt::format(" (and {} smaller)", others) : "";
}

void warn_of_traps(const std::vector<waterline::Trap>& traps, Warnings& warnings) {
  if (traps.empty()) return;
  const waterline::Trap& largest = traps.front();
  warnings.push_back(
      {WarningCode::FILM_TRAPPED,
       fmt::format("the waterline closes around a piece of film of up to {} mm2{}, which "
                   "can then only stretch. Turn the object so that it enters the water edge first",
                   three_digits(largest.area_mm2),
                   and_others(static_cast<std::ptrdiff_t>(traps.size()) - 1)),
       where_of(largest)});
  const auto airy = [](const waterline::Trap& trap) { return trap.ceiling_mm.has_value(); };
  const auto most = std::max_element(
      traps.begin(), traps.end(),
      [](const waterline::Trap& a, const waterline::Trap& b) { return a.air_mm3 < b.air_mm3; });
  const auto count = std::count_if(traps.begin(), traps.end(), airy);
  if (count == 0) return;
  warnings.push_back(
      {WarningCode::AIR_TRAPPED,
       fmt::format("the object traps {} cm3 of air{}, which keeps the water out of the cavity; the "
                   "surface inside stays bare. Turn the object or drill a vent",
                   three_digits(most->air_mm3 / 1000), and_others(count - 1)),
       where_of(*most)});
}

/// Returns the place at which waterlines are furthest apart compared with what the object needs.
double coarsest_mm(const waterline::Coarseness& coarse) {
  if (!coarse.unresolved.empty()) return coarse.unresolved.front().middle_mm();
  return coarse.left_out_mm.empty() ? 0 : coarse.left_out_mm.front();
}

void warn_of_limit(const waterline::Coarseness& coarse, std::size_t most, Warnings& warnings) {
  if (!coarse.any()) return;
  std::string effects;
  if (coarse.widening > 1) {
    effects += fmt::format(" their distance is {} times the usual;", three_digits(coarse.widening));
  }
  if (!coarse.left_out_mm.empty()) {
    effects += fmt::format(" {} small level faces or edges have none of their own;",
                           coarse.left_out_mm.size());
  }
  if (!coarse.unresolved.empty()) {
    effects +=
        fmt::format(" {} changes of the waterline are located only to within {} mm;",
                    coarse.unresolved.size(), three_digits(coarse.unresolved.front().width_mm()));
  }
  warnings.push_back(
      {WarningCode::WATERLINES_LIMITED,
       fmt::format(
           "the object has more details than {} waterlines resolve:{} the map is less exact "
           "there. Leave out small parts, or turn the object",
           most, effects),
       at_immersion(coarsest_mm(coarse))});
}

void warn_of_sections(const waterline::SectionsOff& off, Warnings& warnings) {
  warnings.push_back(
      {WarningCode::SECTIONS_UNCERTAIN,
       fmt::format("the mesh is open or its parts share edges, and its sections enclose {} cm3 "
                   "where vertical lines through it find {} cm3: check the result near its "
                   "openings, or close them in a 3D editor",
                   three_digits(off.sections_mm3 / 1000), three_digits(off.columns_mm3 / 1000)),
       where_of(off)});
}

void warn_of_level_faces(const std::vector<waterline::LevelFace>& faces, Warnings& warnings) {
  if (faces.empty()) return;
  warnings.push_back(
      {WarningCode::AIR_TRAPPED,
       fmt::format("a level face of {} mm2{} meets the water all at once and catches air. Tilt the "
                   "object by 10 to 20 degrees so that it enters the water edge first",
                   three_digits(faces.front().area_mm2),
                   and_others(static_cast<std::ptrdiff_t>(faces.size()) - 1)),
       where_of(faces.front())});
}

/// Warns where the stated error exceeds the tolerance.
void warn_of_error(const DipFigures& figures, const DipOptions& options, Warnings& warnings) {
  if (!figures.error || figures.error->beyond_share <= 0) return;
  warnings.push_back(
      {WarningCode::TOLERANCE_EXCEEDED,
       fmt::format(
           "the stated error of {} of the points exceeds {} mm after {} refinements, most at "
           "this immersion. Turn the object, dip less deep, or accept a larger tolerance",
           percent(figures.error->beyond_share), *options.tolerance_mm,
           DipOptions::kMostRefinements),
       at_immersion(figures.worst_error_immersion_mm)});
}

/// Warns if the film tears or wrinkles and thus no longer behaves like a sheet.
void warn_of_tears(const DipFigures& figures, const film::Profile& profile, Warnings& warnings) {
  const auto warn = [&](double share, WarningCode code, const std::string& message) {
    if (share > 0) {
      warnings.push_back(
          {code, fmt::format("on {} of the surface {}", percent(share), message), {OnSurface{}}});
    }
  };
  warn(figures.torn_share, WarningCode::FILM_TORN,
       fmt::format("the film tears, because it is stretched more than {} times. Dip less deep, "
                   "turn the object, or use a larger film",
                   profile.tear_stretch));
  warn(figures.wrinkled_share, WarningCode::FILM_WRINKLED,
       fmt::format("the film wrinkles, because it is compressed below {} of its width. Turn the "
                   "object or dip less deep",
                   profile.wrinkle_stretch));
}

}  // namespace

DipFigures figures_of(const StokesPass& pass, const flow::SurfaceMap& map,
                      const DipOptions& options) {
  DipFigures figures = figures_of_pass(pass);
  const std::vector<char> all(pass.surface.points.size(), 1);
  measure_part(pass.surface, pass.body, map, options, all, figures);
  figures.level_faces =
      waterline::find_level_faces(pass.body, triangles_with_film(pass.surface, map));
  return figures;
}

void measure_part(const mesh::Surface& surface, const waterline::Body& body,
                  const flow::SurfaceMap& map, const DipOptions& options,
                  const std::vector<char>& counted, DipFigures& figures) {
  Shares shares;
  std::vector<char> is_measured = counted;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Face face = face_of(body, t);
    const bool is_clamped = face.theta_rad > waterline::kThetaLimit_rad;
    const double third_mm2 = face.area_mm2 / 3;
    for (int k = 0; k < 3; ++k) {
      const int v = surface.triangles[t][k];
      if (surface.is_inner(t, k)) continue;
      shares.total += third_mm2;
      if (counted[v] == 0) continue;
      if (is_clamped) shares.clamped += third_mm2;
      if (is_clamped) is_measured[v] = 0;
      const unsigned flags = point_flags(map, v, options.profile);
      if ((flags & kNotReached) == 0) shares.reached += third_mm2;
      if (is_clamped) continue;  // the map is unreliable there
      if ((flags & kWrinkled) != 0) shares.wrinkled += third_mm2;
      if ((flags & kTorn) != 0) shares.torn += third_mm2;
    }
  }
  if (shares.total > 0) {
    figures.coverage = shares.reached / shares.total;
    figures.clamped_share = shares.clamped / shares.total;
    figures.wrinkled_share = shares.wrinkled / shares.total;
    figures.torn_share = shares.torn / shares.total;
  }
  measure_stretch(map, is_measured, figures);
  measure_error(map, counted, options, figures);
}

std::vector<std::uint8_t> face_flags(const StokesPass& pass, const flow::SurfaceMap& map,
                                     const DipOptions& options) {
  std::vector<std::uint8_t> out;
  for (std::size_t t = 0; t < pass.surface.triangles.size(); ++t) {
    unsigned flags = 0;
    bool is_outer = false;
    for (int k = 0; k < 3; ++k) {
      if (pass.surface.is_inner(t, k)) continue;
      is_outer = true;
      flags |= point_flags(map, pass.surface.triangles[t][k], options.profile);
    }
    if ((flags & kNotReached) != 0 && faces_air(pass, t, options.motion)) flags |= kTrappedAir;
    if (is_outer && face_of(pass.body, t).theta_rad > waterline::kThetaLimit_rad) flags |= kClamped;
    out.push_back(static_cast<std::uint8_t>(flags));
  }
  return out;
}

Warnings warnings_of_waterline(const DipFigures& figures, const DipOptions& options) {
  Warnings warnings;
  if (figures.stopped_at_edge) {
    warnings.push_back({WarningCode::FILM_EDGE_REACHED,
                        fmt::format("the waterline reaches the edge of the film {}; the dip ends "
                                    "there, and the part of the object above that waterline is "
                                    "not printed",
                                    options.outline.name),
                        at_immersion(figures.depth_mm)});
  }
  warn_of_traps(figures.traps, warnings);
  warn_of_limit(figures.coarse, options.schedule.most, warnings);
  if (figures.sections_off) warn_of_sections(*figures.sections_off, warnings);
  warn_of_level_faces(figures.level_faces, warnings);
  return warnings;
}

Warnings warnings_of_strain(const DipFigures& figures, const DipOptions& options) {
  Warnings warnings;
  if (figures.clamped_share > 0) {
    warnings.push_back({WarningCode::THETA_CLAMPED,
                        fmt::format("{} of the surface faces up, within 10 degrees of level, where "
                                    "theta is clamped at 170 degrees: do not trust the map there",
                                    percent(figures.clamped_share)),
                        {OnSurface{}}});
  }
  if (options.film_model == FilmModel::kStokes && figures.stretch_max > kStokesStretch) {
    warnings.push_back({WarningCode::STRETCH_BEYOND_STOKES,
                        fmt::format("the film is stretched up to {} times; above {} times, "
                                    "Stokes flow alone is not accurate. Use the sheet model",
                                    three_digits(figures.stretch_max), kStokesStretch),
                        {OnSurface{}}});
  }
  warn_of_tears(figures, options.profile, warnings);
  warn_of_error(figures, options, warnings);
  return warnings;
}

Warnings warnings_of(const DipFigures& figures, const DipOptions& options) {
  Warnings warnings = warnings_of_waterline(figures, options);
  const auto add = [&](const Warnings& more) {
    warnings.insert(warnings.end(), more.begin(), more.end());
  };
  if (figures.coverage < 0.995) {
    warnings.push_back(
        {WarningCode::PARTS_NOT_REACHED,
         fmt::format(
             "film reaches {} of the surface; the rest stays bare. Turn the object or dip it again",
             percent(figures.coverage)),
         {OnSurface{}}});
  }
  if (figures.tiles_limited) {
    warnings.push_back({WarningCode::TILES_LIMITED,
                        "the film folds or tears in more places than the tiles of the map resolve, "
                        "so it is less exact there. Turn the object, dip less deep, or leave out "
                        "small parts",
                        {OnSurface{}}});
  }
  add(warnings_of_strain(figures, options));
  add(warnings_of_profile(options));
  add(warnings_of_motion(figures.steps, figures.passed_over_mm, figures.unsettled_mm));
  return warnings;
}

Warnings warnings_of_profile(const DipOptions& options) {
  constexpr double kFastest_mm_per_s = 10;  // of the dips with which the method was measured
  Warnings warnings;
  if (options.film_model == FilmModel::kStokes && options.profile.drag_length_mm > 0) {
    warnings.push_back({WarningCode::DRAG_IGNORED,
                        "Stokes flow ignores water drag (drag_length_mm). Use the sheet model",
                        {OfItem{"film profile"}}});
  }
  if (options.dip_speed_mm_per_s > kFastest_mm_per_s) {
    warnings.push_back({WarningCode::DIP_FAST,
                        fmt::format("above {} mm/s the water itself moves, which the model leaves "
                                    "out. Dip more slowly, or make a test print",
                                    kFastest_mm_per_s)});
  }
  return warnings;
}

Warnings warnings_of_motion(int steps, const std::vector<double>& passed_over_mm,
                            double unsettled_mm) {
  Warnings warnings;
  if (!passed_over_mm.empty()) {
    const std::size_t all = passed_over_mm.size() + static_cast<std::size_t>(steps);
    warnings.push_back(
        {WarningCode::WATERLINES_PASSED_OVER,
         fmt::format("{} of {} waterlines are passed over, because two of their curves nearly "
                     "touch; there the film's motion comes from the neighbouring waterlines. Widen "
                     "or close such gaps in the model",
                     passed_over_mm.size(), all),
         at_immersion(passed_over_mm.front())});
  }
  if (unsettled_mm > kUnsettled_mm) {
    warnings.push_back(
        {WarningCode::SHEET_UNSETTLED,
         fmt::format(
             "the thickness of the film does not converge, which happens where the film "
             "tears or folds; another sweep would still move the film by {} mm. "
             "Do not trust the result where the stretch is extreme; turn the object or dip less "
             "deep",
             three_digits(unsettled_mm)),
         {OfItem{"film"}}});
  }
  return warnings;
}

}  // namespace hydroprint::pipeline
