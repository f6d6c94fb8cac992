#include "sim/image/io/image_file.h"

#include <system_error>

#include "sim/base/artifact_file.h"
#include "sim/base/module.h"
#include "sim/image/io/codecs.h"
#include "sim/image/io/colour.h"
#include "sim/image/io/grey16.h"
#include "sim/image/io/png.h"
#include "sim/image/io/printer_image.h"

namespace hydroprint::image {
namespace {

/// Loads the module, which is in the same folder as the program, on first use.
Result<const ImageCodecs*> codecs() {
  static const auto symbol = module_symbol("hydroprint-image-codecs.so", "hydroprint_image_codecs");
  if (!symbol) return tl::unexpected(symbol.error());
  return reinterpret_cast<decltype(&hydroprint_image_codecs)>(*symbol)();
}

Status check_file(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    return fail(Code::kNotFound, path.string() + ": no such file. Check the path");
  }
  if (!std::filesystem::is_regular_file(status)) {
    return fail(Code::kInvalidArgument, path.string() + ": not a regular file. Use an image file");
  }
  return {};
}

}  // namespace

void load_image_libraries() { (void)codecs(); }

Result<ReadImage> read_image(const std::filesystem::path& path, const Context& context,
                             const Decoding& decoding) {
  HP_RETURN_IF_ERROR(check_file(path));
  HP_ASSIGN_OR_RETURN(const ImageCodecs* library, codecs());
  return library->read_file(path, context, decoding);
}

Result<Grey16Image> read_grey16(const std::filesystem::path& path, const Context& context) {
  HP_RETURN_IF_ERROR(check_file(path));
  HP_ASSIGN_OR_RETURN(const ImageCodecs* library, codecs());
  return library->read_grey16(path, context);
}

Result<ReadImage> read_image(const std::vector<unsigned char>& bytes, const std::string& name,
                             const Context& context, const Decoding& decoding) {
  HP_ASSIGN_OR_RETURN(const ImageCodecs* library, codecs());
  return library->read_bytes(bytes, name, context, decoding);
}

Status write_png(const std::filesystem::path& path, const RgbImage& image, double dpi,
                 const Context& context) {
  HP_ASSIGN_OR_RETURN(const auto file, encode_png(image, dpi, context));
  return write_artifact(path, file);
}

Status write_png(const std::filesystem::path& path, const Grey16Image& image,
                 const Context& context) {
  HP_ASSIGN_OR_RETURN(const auto file, encode_png(image, context));
  return write_artifact(path, file);
}

Status write_png_rgba(const std::filesystem::path& path, int width, int height,
                      const std::vector<std::uint8_t>& rgba) {
  HP_ASSIGN_OR_RETURN(const ImageCodecs* library, codecs());
  HP_ASSIGN_OR_RETURN(const auto file,
                      library->encode_png_rgba(path.string(), width, height, rgba));
  return write_artifact(path, file);
}

Status write_tiff(const std::filesystem::path& path, const PrinterImage& image, double dpi,
                  const std::string& icc_profile) {
  HP_ASSIGN_OR_RETURN(const ImageCodecs* library, codecs());
  HP_ASSIGN_OR_RETURN(const auto file,
                      library->encode_tiff(path.string(), image, dpi, icc_profile));
  return write_artifact(path, file);
}

void srgb8_row(const Texels& image, int y, std::uint8_t* rgb) {
  static const Srgb8Encoder encode;
  const auto width = static_cast<std::size_t>(image.width);
  const Texel* texels = &image.texels[static_cast<std::size_t>(y) * width];
  for (std::size_t x = 0; x < width; ++x) {
    for (const std::uint16_t linear : {texels[x].r, texels[x].g, texels[x].b}) {
      *rgb++ = encode(static_cast<float>(linear) / 65535.0F);
    }
  }
}

Status write_exr(const std::filesystem::path& path, int width, int height,
                 const std::vector<std::string>& channels, const std::vector<float>& values) {
  HP_ASSIGN_OR_RETURN(const ImageCodecs* library, codecs());
  HP_ASSIGN_OR_RETURN(const auto file,
                      library->encode_exr(path.string(), width, height, channels, values));
  return write_artifact(path, file);
}

}  // namespace hydroprint::image
