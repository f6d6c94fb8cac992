#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/image/io/rgb_image.h"

namespace hydroprint::image {

/// One texel in linear light, 16 bits per channel; `chart` is set by Texture (0 when read).
struct Texel {
  std::uint16_t r = 0, g = 0, b = 0, chart = 0;
};

/// A decoded image, row 0 at the top.
struct Texels {
  int width = 0, height = 0;
  std::vector<Texel> texels;
};

/// Meaning of an alpha channel: blended with white, ignored, or white below a cutoff.
enum class Alpha { kOverWhite, kIgnored, kCutOut };

/// How the values of an image file become colours.
struct Decoding {
  /// True: values are sRGB-coded (floats linear) and rows as stored. False: the image is turned as
  /// its Exif orientation says and converted to sRGB by its ICC profile, else by its gamma.
  bool as_stored = false;
  Alpha alpha = Alpha::kOverWhite;
  float opacity = 1;    ///< multiplies the alpha channel (or takes its place)
  float cutoff = 0.5F;  ///< of kCutOut
  Eigen::Vector3f tint = Eigen::Vector3f::Ones();  ///< multiplies the colour in linear light
};

struct ReadImage {
  Texels image;
  bool had_alpha = false;  ///< had transparent parts, which are white or blended with white
  /// Assumptions made while decoding, for example about an unusable colour profile.
  Warnings warnings;
};

/// Larger images are rejected before they are decoded.
inline constexpr int kMaxImageSide_px = 16384;
inline constexpr std::int64_t kMaxImageArea_px = 200'000'000;

/// Loads the image libraries now instead of at the first image. Call it before work that takes much
/// memory: the libraries end the program if memory runs out while they load.
void load_image_libraries();

/// Reads a PNG, JPEG or TIFF image (detected by content, not by name): grey, RGB or palette, with
/// or without alpha (composited over white in linear light), 8 or 16 bits or floats. Integers are
/// read as sRGB-coded, floats as linear, unless `decoding` and the file say otherwise. Errors name
/// the file: kInvalidArgument for other formats, kOutOfRange for images beyond the limits above,
/// kDataLoss for truncated or corrupt files and files too short for the announced size.
[[nodiscard]] Result<ReadImage> read_image(const std::filesystem::path& path,
                                           const Context& context, const Decoding& decoding = {});

/// Same as above, for an image embedded in another file; `name` identifies it in messages.
[[nodiscard]] Result<ReadImage> read_image(const std::vector<unsigned char>& bytes,
                                           const std::string& name, const Context& context,
                                           const Decoding& decoding = {});

/// Resolution written to pictures for the screen.
inline constexpr double kScreenDpi = 96;

/// Writes a PNG with its resolution (encode_png) atomically, by renaming a temporary file. Errors:
/// kResourceExhausted (reason DISK_FULL) if the disk is full, kPermissionDenied or kNotFound if the
/// file cannot be written.
[[nodiscard]] Status write_png(const std::filesystem::path& path, const RgbImage& image, double dpi,
                               const Context& context = {});

/// Same as write_png(), with an alpha channel (unassociated); `rgba` holds width * height * 4
/// bytes.
[[nodiscard]] Status write_png_rgba(const std::filesystem::path& path, int width, int height,
                                    const std::vector<std::uint8_t>& rgba);

/// Writes interleaved float channels as a zip-compressed OpenEXR file, atomically like write_png().
[[nodiscard]] Status write_exr(const std::filesystem::path& path, int width, int height,
                               const std::vector<std::string>& channels,
                               const std::vector<float>& values);

}  // namespace hydroprint::image
