// The only file that uses OpenImageIO; built as a separate module (codecs.h).
#include "sim/image/io/codecs.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>
#include <optional>
#include <system_error>
#include <type_traits>
#include <utility>

#include "sim/base/check.h"
#include "sim/image/io/header.h"
#include "sim/image/io/orientation.h"
#include "sim/image/io/pixels.h"

namespace hydroprint::image {
namespace {

using OIIO::ImageInput;
using OIIO::ImageOutput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;
using OIIO::Filesystem::IOProxy;

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

tl::unexpected<Error> corrupt(const std::string& name, const std::string& why) {
  return fail(Code::kDataLoss, name + ": truncated or corrupt image (" + first_line(why) +
                                   "). Download or export the file again");
}

PixelLayout layout_of(const ImageSpec& spec) {
  PixelLayout layout;
  layout.channels = spec.nchannels;
  layout.alpha = spec.alpha_channel;
  if (layout.alpha < 0 && (spec.nchannels == 2 || spec.nchannels == 4)) {
    layout.alpha = spec.nchannels - 1;  // TIFF may leave the extra channel unnamed
  }
  layout.premultiplied = spec.get_int_attribute("oiio:UnassociatedAlpha", 0) == 0;
  layout.grey = spec.nchannels < 3;
  layout.is_float = spec.format.is_floating_point();
  return layout;
}

/// Returns the decoding exponent of a PNG that states one other than sRGB's.
std::optional<float> gamma_of(const ImageSpec& spec) {
  const float gamma = spec.get_float_attribute("oiio:Gamma", 0);
  if (!(gamma > 0.1F && gamma < 10)) return {};
  if (spec.get_string_attribute("oiio:ColorSpace") == "sRGB") return {};
  constexpr float kLikeSrgb = 2.2F;  // as the PNG specification says of 45455
  if (std::abs(gamma - kLikeSrgb) < 0.01F) return {};
  return gamma;
}

Warning profile_ignored(const std::string& why, bool is_float, const std::string& name) {
  return {
      WarningCode::PROFILE_IGNORED,
      fmt::format("the colour profile of the image was ignored: {}. Its values were taken as {}",
                  why, is_float ? "linear light" : "sRGB"),
      {InFile{name}}};
}

/// Finds the meaning of the colour values: by a profile, else by a gamma.
/// @param has_profile  the file has one, even if the decoder did not return it
ColourCoding coding_of(const ImageSpec& spec, const PixelLayout& layout, bool has_profile,
                       const std::string& name, Warnings& warnings) {
  const auto* profile = spec.find_attribute("ICCProfile");
  if (profile == nullptr && has_profile) {
    warnings.push_back(profile_ignored("it is damaged or does not fit the image", false, name));
    return {};
  }
  if (profile == nullptr) return {{}, gamma_of(spec)};
  const auto size = profile->type().size();
  auto conversion = ProfileToSrgb::create({static_cast<const std::uint8_t*>(profile->data()), size},
                                          layout.grey ? 1 : 3);
  if (conversion && !layout.is_float) {
    if (conversion->is_srgb()) return {};
    return {std::move(*conversion), {}};
  }
  warnings.push_back(profile_ignored(conversion ? "the image has floats" : conversion.error(),
                                     layout.is_float, name));
  return {};
}

bool read_rows(ImageInput& input, const ImageSpec& spec, int y0, int y1, TypeDesc type, void* to) {
  if (spec.tile_width == 0) {
    return input.read_scanlines(0, 0, y0, y1, 0, 0, spec.nchannels, type, to);
  }
  return input.read_tiles(0, 0, 0, spec.width, y0, y1, 0, 1, 0, spec.nchannels, type, to);
}

/// Reads all pixels to their turned places.
template <class Value>
Status read_pixels(ImageInput& input, const ImageSpec& spec, const std::string& name,
                   const Turned& turned, PixelConverter& converter, const Context& context,
                   ReadImage& out) {
  const int rows = spec.tile_width ? spec.tile_height : 64;
  const std::size_t row = static_cast<std::size_t>(spec.width) * spec.nchannels;
  if (rows < 1 || row * static_cast<std::size_t>(rows) > (std::size_t{1} << 29)) {
    return corrupt(name, fmt::format("tiles of {} rows", spec.tile_height));
  }
  std::vector<Value> buffer(row * static_cast<std::size_t>(rows));
  const bool is_float = std::is_same_v<Value, float>;
  const auto width = static_cast<std::size_t>(spec.width);
  std::vector<Texel> line(turned.is_identity() ? 0 : width);
  for (int y = 0; y < spec.height; y += rows) {
    HP_RETURN_IF_ERROR(check_cancelled(context));
    const int end = std::min(y + rows, spec.height);
    const bool read = read_rows(input, spec, y, end, is_float ? TypeDesc::FLOAT : TypeDesc::UINT16,
                                buffer.data());
    if (!read || input.has_error()) return corrupt(name, input.geterror());
    for (int below = y; below < end; ++below) {
      const Value* from = &buffer[row * static_cast<std::size_t>(below - y)];
      if (turned.is_identity()) {
        converter.convert(from, width, &out.image.texels[width * static_cast<std::size_t>(below)]);
        continue;
      }
      converter.convert(from, width, line.data());
      for (int x = 0; x < spec.width; ++x) out.image.texels[turned.index(x, below)] = line[x];
    }
  }
  out.had_alpha = converter.had_alpha();
  return {};
}

/// An image file whose header has been checked.
struct Opened {
  std::unique_ptr<ImageInput> input;
  ImageSpec spec;
  bool has_profile = false;  ///< the file has a profile, even if the decoder does not return it
};

Result<Opened> open(IOProxy& proxy, const std::string& name) {
  const ByteSource bytes{static_cast<std::int64_t>(proxy.size()),
                         [&](void* to, std::size_t count, std::int64_t offset) {
                           return proxy.pread(to, count, offset);
                         }};
  HP_ASSIGN_OR_RETURN(const FileHeader header, check_header(bytes, name));
  const Format format = header.format;
  Opened out{ImageInput::create(decoder_name(format), false, nullptr), {}, header.has_profile};
  if (!out.input || !out.input->set_ioproxy(&proxy)) {
    return fail(Code::kUnimplemented,
                name + ": no decoder for " + decoder_name(format) +
                    ". Convert the image to another format (PNG, JPEG or TIFF)");
  }
  ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  if (!out.input->open(name, out.spec, config)) return corrupt(name, out.input->geterror());
  HP_RETURN_IF_ERROR(check_size(out.spec.width, out.spec.height, bytes.size, format, name));
  if (out.spec.depth > 1 || out.spec.nchannels < 1 || out.spec.nchannels > 64) {
    return corrupt(name, fmt::format("{} channels", out.spec.nchannels));
  }
  return out;
}

Result<ReadImage> decode(IOProxy& proxy, const std::string& name, const Context& context,
                         const Decoding& decoding) {
  HP_ASSIGN_OR_RETURN(const Opened opened, open(proxy, name));
  const ImageSpec& spec = opened.spec;
  ReadImage out;
  const PixelLayout layout = layout_of(spec);
  const Turned turned(decoding.as_stored ? 1 : spec.get_int_attribute("Orientation", 1), spec.width,
                      spec.height);
  ColourCoding coding;
  if (!decoding.as_stored) coding = coding_of(spec, layout, opened.has_profile, name, out.warnings);
  PixelConverter converter(layout, std::move(coding), decoding);
  out.image.width = turned.width();
  out.image.height = turned.height();
  out.image.texels.resize(static_cast<std::size_t>(spec.width) * spec.height);
  HP_RETURN_IF_ERROR(
      layout.is_float
          ? read_pixels<float>(*opened.input, spec, name, turned, converter, context, out)
          : read_pixels<std::uint16_t>(*opened.input, spec, name, turned, converter, context, out));
  return out;
}

Result<Grey16Image> decode_grey16(IOProxy& proxy, const std::string& name) {
  HP_ASSIGN_OR_RETURN(const Opened opened, open(proxy, name));
  const ImageSpec& spec = opened.spec;
  if (spec.nchannels != 1 || spec.format != TypeDesc::UINT16 || spec.tile_width != 0) {
    return fail(Code::kInvalidArgument,
                name + ": not a 16-bit grey image. Use depth images written by hydroprint-capture");
  }
  Grey16Image out{spec.width, spec.height, {}};
  out.grey.resize(static_cast<std::size_t>(spec.width) * spec.height);
  if (!read_rows(*opened.input, spec, 0, spec.height, TypeDesc::UINT16, out.grey.data()) ||
      opened.input->has_error()) {
    return corrupt(name, opened.input->geterror());
  }
  return out;
}

/// Runs a decoder and turns exceptions into errors. The libraries behind OpenImageIO report errors
/// through return values, but C++ exceptions are possible and must not leave this file.
template <class Decode>
auto safely(const std::string& name, Decode decode) -> decltype(decode()) {
  try {
    return decode();
  } catch (const std::bad_alloc&) {
    return fail(Code::kResourceExhausted,
                name + ": not enough memory for this image. Scale it down",
                ErrorReason::MEMORY_LIMIT);
  } catch (const std::exception& exception) {
    return corrupt(name, exception.what());
  }
}

/// @param name  for messages; must have the extension that the encoder expects
Result<std::vector<unsigned char>> encode(const std::string& name, const char* encoder,
                                          const ImageSpec& spec, TypeDesc type,
                                          const void* pixels) {
  std::vector<unsigned char> file;
  OIIO::Filesystem::IOVecOutput proxy(file);
  try {
    const auto output = ImageOutput::create(encoder);
    if (!output || !output->set_ioproxy(&proxy) || !output->open(name, spec) ||
        !output->write_image(type, pixels) || !output->close()) {
      const std::string why = output ? output->geterror() : "no encoder";
      return fail(Code::kInternal,
                  name + ": encoding failed (" + first_line(why) + "). Please report this");
    }
  } catch (const std::exception& exception) {
    return fail(Code::kInternal, name + ": encoding failed (" + exception.what() +
                                     "). Check that enough memory is free");
  }
  return file;
}

/// Opens a file and decodes it.
template <class Decode>
auto from_file(const std::filesystem::path& path, Decode decode)
    -> decltype(decode(std::declval<IOProxy&>())) {
  OIIO::Filesystem::IOFile proxy(path.string(), IOProxy::Read);
  if (!proxy.opened()) {
    return fail(Code::kPermissionDenied,
                path.string() + ": cannot be opened. Check its permissions");
  }
  return safely(path.string(), [&] { return decode(proxy); });
}

Result<ReadImage> read_file(const std::filesystem::path& path, const Context& context,
                            const Decoding& decoding) {
  return from_file(path,
                   [&](IOProxy& proxy) { return decode(proxy, path.string(), context, decoding); });
}

Result<Grey16Image> read_grey16_file(const std::filesystem::path& path, const Context&) {
  return from_file(path, [&](IOProxy& proxy) { return decode_grey16(proxy, path.string()); });
}

Result<ReadImage> read_bytes(const std::vector<unsigned char>& bytes, const std::string& name,
                             const Context& context, const Decoding& decoding) {
  OIIO::Filesystem::IOMemReader proxy(bytes.data(), bytes.size());
  return safely(name, [&] { return decode(proxy, name, context, decoding); });
}

Result<std::vector<unsigned char>> encode_png_rgba(const std::string& name, int width, int height,
                                                   const std::vector<std::uint8_t>& rgba) {
  HP_CHECK(rgba.size() == 4 * static_cast<std::size_t>(width) * height);
  ImageSpec spec(width, height, 4, TypeDesc::UINT8);
  spec.attribute("png:compressionLevel", 1);
  spec.attribute("oiio:ColorSpace", "sRGB");
  spec.alpha_channel = 3;
  spec.attribute("oiio:UnassociatedAlpha", 1);
  return encode(name, "png", spec, TypeDesc::UINT8, rgba.data());
}

Result<std::vector<unsigned char>> encode_tiff(const std::string& name, const PrinterImage& image,
                                               double dpi, const std::string& icc_profile) {
  HP_CHECK(image.samples.size() == image.row_bytes() * image.height);
  ImageSpec spec(image.width, image.height, image.channels, TypeDesc::UINT8);
  spec.attribute("compression", "lzw");
  spec.attribute("XResolution", static_cast<float>(dpi));
  spec.attribute("YResolution", static_cast<float>(dpi));
  spec.attribute("ResolutionUnit", "in");
  // Without this attribute, the library writes the current time, and equal images must yield equal
  // files. The value is Exif's code for an unknown time (Exif 2.3, tag 306).
  spec.attribute("DateTime", "    :  :     :  :  ");
  if (image.channels == 4) {
    spec.channelnames = {"C", "M", "Y", "K"};
    spec.alpha_channel = -1;
    spec.attribute("tiff:ColorSpace", "CMYK");
  }
  if (!icc_profile.empty()) {
    spec.attribute("ICCProfile", TypeDesc(TypeDesc::UINT8, static_cast<int>(icc_profile.size())),
                   icc_profile.data());
  }
  return encode(name, "tiff", spec, TypeDesc::UINT8, image.samples.data());
}

Result<std::vector<unsigned char>> encode_exr(const std::string& name, int width, int height,
                                              const std::vector<std::string>& channels,
                                              const std::vector<float>& values) {
  HP_CHECK(values.size() == channels.size() * static_cast<std::size_t>(width) * height);
  ImageSpec spec(width, height, static_cast<int>(channels.size()), TypeDesc::FLOAT);
  spec.channelnames = channels;
  spec.attribute("compression", "zip");
  spec.attribute("DateTime",
                 "");  // otherwise the current time; equal images must yield equal files
  return encode(name, "openexr", spec, TypeDesc::FLOAT, values.data());
}

}  // namespace
}  // namespace hydroprint::image

const hydroprint::image::ImageCodecs* hydroprint_image_codecs() {
  using namespace hydroprint::image;
  static const ImageCodecs codecs = {read_file,   read_bytes, encode_png_rgba,
                                     encode_tiff, encode_exr, read_grey16_file};
  return &codecs;
}
