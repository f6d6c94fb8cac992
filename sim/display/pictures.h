#pragma once

#include <cstddef>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/display/display_model.h"
#include "sim/image/texture/texture.h"

namespace hydroprint::display {

/// Limits of the textures that are shown.
struct PictureLimits {
  int side_px = 2048;
  std::size_t total_bytes = std::size_t{32} << 20;  ///< of all encoded images
};

/// The textures for display.
struct Pictures {
  std::vector<Picture> pictures;  ///< one for each texture
  int halvings = 0;               ///< beyond side_px, so that they fit into total_bytes
};

/// Encodes textures. Those with a longer side than allowed are halved until they fit; if all
/// together are still too large, every texture is halved once more, and so on.
/// @return kCancelled; kInternal if memory runs out
[[nodiscard]] Result<Pictures> show_pictures(const std::vector<image::Texture>& textures,
                                             const PictureLimits& limits, const Context& context);

}  // namespace hydroprint::display
