#pragma once

#include <span>
#include <string>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/pose.h"
#include "sim/base/result.h"
#include "sim/flow/surface_map.h"
#include "sim/image/figures/depth_buffer.h"
#include "sim/mesh/surface.h"

namespace hydroprint::image {

/// Width of a sheet of pictures, and of the margin around each view.
inline constexpr int kSheetWidth_px = 1360;
inline constexpr int kMargin_px = 40;

/// The standard views of an object with film on it, in their order on the sheet, row by row. The
/// visible parts are computed once for all pictures.
struct ObjectViews {
  const mesh::Surface& surface;
  int columns = 2;
  int width_px = 0, height_px = 0;  ///< size of a view
  std::vector<std::string> names;
  std::vector<SeenObject> seen;
};

/// Computes the views of an object in the orientation in which it enters the water (+z of F up).
/// Surface and tiles must outlive the views.
/// @param tiles  film that has landed; empty: the object alone
[[nodiscard]] Result<ObjectViews> find_views(const mesh::Surface& surface, const Pose& X_FO,
                                             std::span<const flow::MappedTriangle> tiles,
                                             const Context& context);

}  // namespace hydroprint::image
