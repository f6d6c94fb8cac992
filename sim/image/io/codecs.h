#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/image/io/grey16.h"
#include "sim/image/io/image_file.h"
#include "sim/image/io/printer_image.h"

namespace hydroprint::image {

/// The functions that need an image library; image_file.h, printer_image.h and grey16.h document
/// them. OpenImageIO depends on some two hundred libraries that take a third of a second to load,
/// and most runs need none of them. These functions are therefore in a module that is loaded on
/// first use.
struct ImageCodecs {
  Result<ReadImage> (*read_file)(const std::filesystem::path& path, const Context& context,
                                 const Decoding& decoding);
  Result<ReadImage> (*read_bytes)(const std::vector<unsigned char>& bytes, const std::string& name,
                                  const Context& context, const Decoding& decoding);
  Result<std::vector<unsigned char>> (*encode_png_rgba)(const std::string& name, int width,
                                                        int height,
                                                        const std::vector<std::uint8_t>& rgba);
  Result<std::vector<unsigned char>> (*encode_tiff)(const std::string& name,
                                                    const PrinterImage& image, double dpi,
                                                    const std::string& icc_profile);
  Result<std::vector<unsigned char>> (*encode_exr)(const std::string& name, int width, int height,
                                                   const std::vector<std::string>& channels,
                                                   const std::vector<float>& values);
  Result<Grey16Image> (*read_grey16)(const std::filesystem::path& path, const Context& context);
};

}  // namespace hydroprint::image

/// The only symbol that the module exports.
extern "C" const hydroprint::image::ImageCodecs* hydroprint_image_codecs();
