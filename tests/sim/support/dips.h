#pragma once

#include <string>

#include "sim/film/outline.h"
#include "sim/flow/trace.h"
#include "sim/mesh/surface.h"
#include "sim/velocity/film_mesh.h"
#include "sim/waterline/body.h"
#include "sim/waterline/motion.h"
#include "sim/waterline/schedule.h"

namespace hydroprint::testing {

/// Settings of a test's dip: like the pipeline, but with access to every stage.
struct DipSetting {
  film::Outline film;
  double depth_mm = 1e9;  ///< depth of the dip; at most the body's height is used
  waterline::ScheduleOptions schedule;
  velocity::MeshOptions mesh;
  waterline::Motion motion;
  double max_edge_mm = 2;

  /// Multiplies every length of the discretisation by `factor`.
  void coarsen(double factor);
};

struct SolvedDip {
  mesh::Surface surface;
  waterline::Body body;
  flow::DipField field;
};

/// Waterlines, film meshes and velocities of a dip of the model, whose x and y are film
/// coordinates.
[[nodiscard]] SolvedDip solve_dip(const mesh::Model& model, const DipSetting& setting);

/// A circular film with few corners: a regular polygon with the area of the circle.
[[nodiscard]] film::Outline round_film(double radius_mm, int corners = 120, double turn_rad = 0);

[[nodiscard]] film::Outline film_of(const std::string& text);

}  // namespace hydroprint::testing
