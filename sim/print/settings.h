#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>

#include "sim/base/result.h"

namespace hydroprint::print {

/// What a film image is printed on, and how.
struct PageSettings {
  Eigen::Vector2d paper_mm = {210, 297};  ///< as it lies in the tray; turned where that fits better
  /// What the printer cannot print along every edge of the paper, mm; 0: all of it can be printed.
  double printer_margin_mm = 0;
  /// What neighbouring sheets have in common where the film takes several, mm.
  double overlap_mm = 10;
  /// Length of the sliding bars that hold the film at the middle of its four sides (section 5.1): a
  /// mark where each begins and ends, beside that of its middle; 0: of its middle alone.
  double bar_mm = 0;
  bool mirror = false;   ///< off: ink side up, seen from above
  bool marks = true;     ///< around the film, where there is room
  std::string job_name;  ///< on the paper; empty: none
  std::string date;      ///< on the paper, as given; empty: none
};

/// Which colours the printer is given.
struct ColourSettings {
  bool cmyk = false;  ///< without a profile: plain CMYK, as ink::make_separation has it; else sRGB
  std::filesystem::path icc_profile;  ///< of the printer, which says whether it takes CMYK or RGB
  /// The most C + M + Y + K of a pixel, above 0 to 4; CMYK alone.
  double ink_limit = 4;
};

/// Reads "A4", "A3", "letter" or "WxH" (mm). Refuses (kInvalidArgument) what it does not understand
/// and (kOutOfRange) sides below 10 mm or above 2000 mm.
[[nodiscard]] Result<Eigen::Vector2d> parse_paper(const std::string& text);

/// A number as messages have it: six digits, no zeros behind them.
[[nodiscard]] std::string text_of(double value);

/// Refuses (kOutOfRange), naming the setting, what is out of range or does not fit together.
[[nodiscard]] Status check(const PageSettings& settings);

}  // namespace hydroprint::print
