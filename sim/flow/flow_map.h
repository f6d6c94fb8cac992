#pragma once

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/flow/surface_map.h"
#include "sim/flow/trace.h"
#include "sim/mesh/surface.h"
#include "sim/waterline/body.h"
#include "sim/waterline/motion.h"

namespace hydroprint::flow {

struct MapOptions {
  double dip_speed_mm_per_s = 5;
  /// Printed (x, y) floats at (s_x x, s_y y), see film::Profile.
  Eigen::Vector2d swelling = {1, 1};
  /// Tiles are divided until the map is linear on each of them to within this tolerance, measured
  /// on the film. The tolerance doubles with each division, so that scatter of the traced points is
  /// not mistaken for a jump.
  double tolerance_mm = 0.02;
  /// Tile edges shorter than this on the film are not divided further (a pixel at 600 dpi).
  double least_edge_mm = 0.042;
  bool make_tiles = true;
  /// The stated error is TracedBack::error_mm times this factor; 0: none is stated.
  double error_factor = 0;
  double pixel_mm = 25.4 / 600;  ///< of the film image
};

/// Adapts options made for 600 dpi to an image of another resolution. Larger pixels allow a coarser
/// map: tolerance and least edge stay the same in pixels down to 150 dpi. Resolutions above 600 dpi
/// change nothing.
/// @param dpi  positive
[[nodiscard]] MapOptions for_resolution(MapOptions options, double dpi);

/// Computes for every point of the surface the film point that lands there, and tiles the part of
/// the surface that the film reaches.
[[nodiscard]] Result<FlowMap> make_flow_map(const mesh::Surface& surface,
                                            const waterline::Body& body, const DipField& dip,
                                            const waterline::Motion& motion,
                                            const MapOptions& options, const Context& context);

}  // namespace hydroprint::flow
