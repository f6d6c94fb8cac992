#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/base/context.h"
#include "sim/registration/shape.h"
#include "sim/scan/cloud.h"

namespace hydroprint::registration {

/// The board in one image.
struct BoardView {
  std::vector<scan::ScanPoint> points;  ///< one for each patch
  Pose X_CB = Pose::Identity();
};

/// Finds the board in a cloud: the connected piece of the board's size that fits best.
/// @return nullopt if no piece fits
[[nodiscard]] Result<std::optional<BoardView>> find_board(const scan::Cloud& cloud,
                                                          const Shape& board, int patch_px,
                                                          const Context& context);

/// Returns why the views do not suffice to calibrate a camera; empty if they do.
[[nodiscard]] std::string lacking(const std::vector<BoardView>& views, const scan::Lens& lens);

}  // namespace hydroprint::registration
