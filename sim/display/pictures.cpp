#include "sim/display/pictures.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "sim/image/io/colour.h"
#include "sim/image/io/png.h"

namespace hydroprint::display {
namespace {

image::RgbImage coded(const image::Texels& texels) {
  const image::Srgb8Encoder encode;
  image::RgbImage out{texels.width, texels.height, {}};
  out.rgb.reserve(3 * texels.texels.size());
  for (const image::Texel& texel : texels.texels) {
    for (const std::uint16_t value : {texel.r, texel.g, texel.b})
      out.rgb.push_back(encode(static_cast<float>(value) / 65535.0F));
  }
  return out;
}

/// Returns the texture's largest level within the limit, halved some more times.
const image::Texels& level_of(const image::Texture& texture, int side_px, int halvings) {
  const auto& levels = texture.levels();
  std::size_t level = 0;
  while (level + 1 < levels.size() && std::max(levels[level].width, levels[level].height) > side_px)
    ++level;
  return levels[std::min(level + static_cast<std::size_t>(halvings), levels.size() - 1)];
}

/// @return nullopt if the images are too large together
Result<std::optional<std::vector<Picture>>> encode(const std::vector<image::Texture>& textures,
                                                   const PictureLimits& limits, int halvings,
                                                   const Context& context) {
  std::vector<Picture> out;
  std::size_t bytes = 0;
  for (const image::Texture& texture : textures) {
    const image::RgbImage image = coded(level_of(texture, limits.side_px, halvings));
    HP_ASSIGN_OR_RETURN(auto png, image::encode_png(image, image::kScreenDpi, context));
    bytes += png.size();
    if (bytes > limits.total_bytes) return std::nullopt;
    out.push_back({std::move(png), texture.wrap()[0], texture.wrap()[1]});
  }
  return out;
}

}  // namespace

Result<Pictures> show_pictures(const std::vector<image::Texture>& textures,
                               const PictureLimits& limits, const Context& context) {
  constexpr int kMostHalvings = 15;  // to a texel, from the largest image that is read
  for (int halvings = 0;; ++halvings) {
    HP_ASSIGN_OR_RETURN(auto pictures, encode(textures, limits, halvings, context));
    if (pictures) return Pictures{std::move(*pictures), halvings};
    if (halvings == kMostHalvings) break;
  }
  return fail(Code::kResourceExhausted,
              "the model has too many textures to show. Unite some of them in a 3D editor");
}

}  // namespace hydroprint::display
