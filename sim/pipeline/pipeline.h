#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/pose.h"
#include "sim/base/result.h"
#include "sim/film/outline.h"
#include "sim/film/profile.h"
#include "sim/flow/flow_map.h"
#include "sim/ink/ink_field.h"
#include "sim/mesh/model.h"
#include "sim/mesh/surface.h"
#include "sim/sheet/sheet_flow.h"
#include "sim/velocity/film_mesh.h"
#include "sim/waterline/check_sections.h"
#include "sim/waterline/level_faces.h"
#include "sim/waterline/motion.h"
#include "sim/waterline/schedule.h"
#include "sim/waterline/traps.h"
#include "sim/waterline/waterlines.h"

namespace hydroprint::pipeline {

/// Model of the film's motion: Stokes flow (section 4.2), or a viscous sheet whose thickness
/// matters (section 4.3).
enum class FilmModel { kStokes, kSheet };

/// Options of one dip: the object's pose and motion, and the film.
struct DipOptions {
  /// Pose of the object at the start of the dip (object frame to film frame); z is ignored.
  /// nullopt: orientation as in the file, bounding box centred on the film.
  std::optional<Pose> X_FO;
  film::Outline outline;
  film::Profile profile;
  std::optional<double> depth_mm;  ///< immersion at the end of the dip; nullopt: full
  double dip_speed_mm_per_s = 5;
  FilmModel film_model = FilmModel::kSheet;
  /// True to model inertia as in Algorithm 1; false for the quasistatic sheet. With inertia, the
  /// computation is slower and yields the same result.
  bool inertia = false;
  ink::InkField ink;         ///< printed on the film; used by the sheet only
  waterline::Motion motion;  ///< the measured horizontal path; empty: straight down
  bool states_error = true;  ///< whether the map has a stated error
  /// Where the stated error exceeds this, waterlines are added, at most kMostRefinements times.
  std::optional<double> tolerance_mm;
  static constexpr int kMostRefinements = 3;
  // Resolution: the defaults are both fast and accurate (tests/bench).
  double surface_edge_mm = 2;  ///< faces with longer edges are subdivided
  waterline::ScheduleOptions schedule;
  velocity::MeshOptions mesh;
  sheet::SheetOptions sheet;  ///< drag is taken from the profile
  flow::MapOptions map;       ///< dip speed and swelling are taken from the members above
};

/// Returns the options with every resolution length multiplied by `factor`; a factor below 1
/// refines the computation.
[[nodiscard]] DipOptions scaled_resolution(DipOptions options, double factor);

/// Distances on the film by which the points that land on the surface have moved since the previous
/// ink pass.
struct InkPass {
  double moved_rms_mm = 0;
  double moved_most_mm = 0;  ///< the 99.9th percentile over the surface's points
  double moved_max_mm = 0;
};

/// Stated error of the film points that land on a part of the surface. Quantiles and shares by
/// points.
struct MapError {
  double p50_mm = 0, p95_mm = 0;  ///< of the points with a bound; infinite if there are none
  double above_pixel_share = 0;   ///< above a pixel of the film image
  double no_bound_share = 0;      ///< without a bound, because the film has torn before
  double beyond_share = 0;        ///< above DipOptions::tolerance_mm
};

/// Figures of a dip for the report.
struct DipFigures {
  double depth_mm = 0;           ///< immersion reached
  bool stopped_at_edge = false;  ///< the waterline reached the film's edge before `depth_mm`
  int steps = 0;                 ///< number of waterlines solved
  /// Immersions of the waterlines that were not solved because two of their curves nearly touch.
  std::vector<double> passed_over_mm;
  std::vector<InkPass> ink_passes;
  int film_vertices_max = 0;  ///< number of vertices of the largest film mesh
  int film_triangles_max = 0;
  double coverage = 0;       ///< fraction of the object's outer surface that the film reaches
  double clamped_share = 0;  ///< fraction of the surface where theta exceeds 170 degrees
  /// Fraction of the surface where the film is compressed below wrinkle_stretch.
  double wrinkled_share = 0;
  /// Fraction of the surface where the film is stretched beyond tear_stretch.
  double torn_share = 0;
  /// Displacement of the sheet in the last sweep, where the sheet tears or folds; see
  /// sheet::SheetFlow.
  double unsettled_mm = 0;
  /// Trapped film and air, largest first; without Trap::air.
  std::vector<waterline::Trap> traps;
  waterline::Coarseness coarse;                  ///< where waterlines are further apart than wanted
  std::vector<waterline::SectionArea> sections;  ///< one per waterline
  std::optional<waterline::SectionsOff> sections_off;  ///< see StokesPass
  bool tiles_limited = false;                          ///< see flow::FlowMap::is_limited
  /// Level faces that catch air, largest first; none in hollows that the film does not reach.
  std::vector<waterline::LevelFace> level_faces;
  /// Median, 95th percentile and maximum of the stretch, where theta is not clamped.
  double stretch_p50 = 0, stretch_p95 = 0, stretch_max = 0;
  std::optional<MapError> error;        ///< nullopt: none is stated, or no film arrives
  double worst_error_immersion_mm = 0;  ///< where the stated error is largest
};

/// Problems of a face, as bits of the property `flags` of surface_map.ply; see face_flags().
enum FaceFlag : std::uint8_t {
  kTorn = 1,
  kWrinkled = 2,
  kClamped = 4,      ///< theta exceeds 170 degrees
  kNotReached = 8,   ///< no film arrives
  kTrappedAir = 16,  ///< air that cannot escape keeps the film away
  kNoAnswer = 32     ///< the stated error has no bound
};

/// The result of a dip: the surface used in the computation and the film's landing on it.
struct Dip {
  mesh::Surface surface;
  Pose X_FO;  ///< pose as used: lowest point on the water, z = 0
  flow::FlowMap map;
  std::vector<std::uint8_t> face_flags;  ///< for each triangle of the surface, a set of FaceFlag
  DipFigures figures;
  Warnings warnings;
};

}  // namespace hydroprint::pipeline
