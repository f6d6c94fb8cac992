#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/base/context.h"
#include "sim/registration/shape.h"
#include "sim/scan/cloud.h"

namespace hydroprint::registration {

/// A board in one image.
struct BoardView {
  std::vector<scan::ScanPoint> points;  ///< one a patch
  Pose X_CB = Pose::Identity();
};

/// The board in a cloud: the piece that has its size, aligned as fits best.
/// @return nothing if there is none
[[nodiscard]] Result<std::optional<BoardView>> find_board(const scan::Cloud& cloud,
                                                          const Shape& board, int patch_px,
                                                          const Context& context);

/// What a set of views lacks to calibrate a camera by; empty: nothing.
[[nodiscard]] std::string lacking(const std::vector<BoardView>& views, const scan::Lens& lens);

}  // namespace hydroprint::registration
