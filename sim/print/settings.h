#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>

#include "sim/base/result.h"

namespace hydroprint::print {

/// The paper for a film image, and the layout on it.
struct PageSettings {
  Eigen::Vector2d paper_mm = {210, 297};  ///< as it lies in the tray; rotated if that fits better
  /// Width of the strip along every edge of the paper that the printer cannot print, mm.
  double printer_margin_mm = 0;
  /// Overlap of neighbouring sheets if the film needs several, mm.
  double overlap_mm = 10;
  /// Length of the sliding bars that hold the film at the middle of its four sides (section 5.1).
  /// Each bar has marks at its two ends and its middle; 0: only at its middle.
  double bar_mm = 0;
  bool mirror = false;   ///< off: ink side up, seen from above
  bool marks = true;     ///< around the film, where there is room
  std::string job_name;  ///< on the paper; empty: none
  std::string date;      ///< on the paper, as given; empty: none
};

/// The colours that are sent to the printer.
struct ColourSettings {
  bool cmyk = false;  ///< without a profile: plain CMYK, as in ink::make_separation; else sRGB
  std::filesystem::path icc_profile;  ///< of the printer; selects CMYK or RGB
  /// The largest C + M + Y + K of a pixel, above 0 and at most 4; CMYK only.
  double ink_limit = 4;
};

/// Parses "A4", "A3", "letter" or "WxH" (mm). Errors: kInvalidArgument for other texts, kOutOfRange
/// for sides below 10 mm or above 2000 mm.
[[nodiscard]] Result<Eigen::Vector2d> parse_paper(const std::string& text);

/// Refuses (kOutOfRange), naming the setting, values out of range and settings that contradict each
/// other.
[[nodiscard]] Status check(const PageSettings& settings);

}  // namespace hydroprint::print
