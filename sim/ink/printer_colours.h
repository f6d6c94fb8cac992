#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "sim/base/result.h"

namespace hydroprint::ink {

/// A printer's ICC output profile, by Little CMS: from 8-bit sRGB to its own channels, relative
/// colorimetric, without black point compensation. Copies share what is behind them.
class PrinterColours {
 public:
  /// Refuses, naming the file: one that is missing or cannot be read; profiles of other devices and
  /// of colour spaces but CMYK and RGB (kInvalidArgument); damaged ones (kDataLoss); more than
  /// 64 MiB (kOutOfRange).
  [[nodiscard]] static Result<PrinterColours> open(const std::filesystem::path& icc_profile);

  /// 4: C M Y K; 3: R G B.
  [[nodiscard]] int channels() const;
  /// @param out  count times channels() values, 65535 being all of it. From any thread.
  void convert(const std::uint8_t* rgb, std::size_t count, std::uint16_t* out) const;
  /// The profile itself, to go with what is converted.
  [[nodiscard]] const std::string& icc_profile() const { return icc_profile_; }

 private:
  class LittleCms;
  PrinterColours() = default;

  std::string icc_profile_;
  std::shared_ptr<const LittleCms> cms_;
};

}  // namespace hydroprint::ink
