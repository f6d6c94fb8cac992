#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "sim/base/result.h"

namespace hydroprint::ink {

/// Converts 8-bit sRGB to a printer's own channels with its ICC output profile (Little CMS,
/// relative colorimetric, without black point compensation). Copies share their data.
class PrinterColours {
 public:
  /// Errors name the file: kNotFound or kPermissionDenied if it cannot be read; kInvalidArgument
  /// for profiles of other devices and of colour spaces other than CMYK and RGB; kDataLoss for
  /// damaged profiles; kOutOfRange for more than 64 MiB.
  [[nodiscard]] static Result<PrinterColours> open(const std::filesystem::path& icc_profile);

  /// Returns 4 for C M Y K and 3 for R G B.
  [[nodiscard]] int channels() const;
  /// May be called from any thread.
  /// @param out  receives `count` times channels() values from 0 to 65535
  void convert(const std::uint8_t* rgb, std::size_t count, std::uint16_t* out) const;
  /// Returns the profile itself, to embed in converted images.
  [[nodiscard]] const std::string& icc_profile() const { return icc_profile_; }

 private:
  class LittleCms;
  PrinterColours() = default;

  std::string icc_profile_;
  std::shared_ptr<const LittleCms> cms_;
};

}  // namespace hydroprint::ink
