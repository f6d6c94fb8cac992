#pragma once

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <vector>

#include "sim/image/io/colour.h"
#include "sim/image/io/image_file.h"

namespace hydroprint::image::testing {

/// Writes an image with OpenImageIO, to test reading formats that this project never writes.
template <class Value>
void write_with_oiio(const std::filesystem::path& path, OIIO::ImageSpec spec, OIIO::TypeDesc type,
                     const std::vector<Value>& values) {
  spec.attribute("oiio:UnassociatedAlpha", 1);
  const auto output = OIIO::ImageOutput::create(path.string());
  ASSERT_TRUE(output);
  ASSERT_TRUE(output->open(path.string(), spec)) << output->geterror();
  ASSERT_TRUE(output->write_image(type, values.data())) << output->geterror();
  ASSERT_TRUE(output->close());
}

/// Returns the 8-bit sRGB codes of a texel.
inline std::array<int, 3> srgb8(const Texel& texel) {
  return {srgb8_from_linear(static_cast<float>(texel.r) / 65535.0F),
          srgb8_from_linear(static_cast<float>(texel.g) / 65535.0F),
          srgb8_from_linear(static_cast<float>(texel.b) / 65535.0F)};
}

}  // namespace hydroprint::image::testing
