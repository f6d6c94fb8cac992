#pragma once

#include <optional>

#include "sim/mesh/surface.h"
#include "sim/pipeline/dip.h"

namespace hydroprint::pipeline {

/// Returns options for a coarse version of the dip, fast enough for a page on which the user turns
/// the object. It uses Stokes flow on the model's own triangles, with a film mesh and steps just
/// fine enough to show the film's landing (to a millimetre on the film up to theta = 120 degrees).
/// The stretch is less accurate: up to 50 % off near the end of the dip. Effects of the sheet and
/// its ink are not modelled.
[[nodiscard]] DipOptions preview_of(DipOptions options);

/// The surfaces of a model for its previews, which do not depend on the pose.
struct PreviewSurfaces {
  mesh::Surface whole;                 ///< its waterlines move the film
  std::optional<mesh::Surface> shown;  ///< that of the map, if the model is shown thinned
};

/// Makes the surfaces of a model. Returns the errors of mesh::make_surface() and check_solid().
/// @param shape  what is shown of the model (display::shown_shape()); if it is not thinned, it
///               serves for both surfaces
[[nodiscard]] Result<PreviewSurfaces> make_preview_surfaces(const mesh::Model& model,
                                                            const mesh::Model& shape,
                                                            const Context& context);

/// Computes a preview. The map's points are first the vertices of the shape, in its order.
/// @param options  those of the whole dip; see preview_of()
/// @return the errors of dip()
[[nodiscard]] Result<Dip> preview_dip(const mesh::Model& model, const PreviewSurfaces& surfaces,
                                      const DipOptions& options, const Context& context);

}  // namespace hydroprint::pipeline
