#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>

#include "sim/base/result.h"

namespace hydroprint::print {

/// The paper for a film image, and the layout of the image on it.
struct PageSettings {
  /// Size of the paper as it lies in the tray; the image is rotated if it fits better that way.
  Eigen::Vector2d paper_mm = {210, 297};
  /// Width, in mm, of the margin on every edge of the paper in which the printer cannot print.
  double printer_margin_mm = 0;
  /// Overlap of neighbouring sheets if the film needs several, mm.
  double overlap_mm = 10;
  /// Length of the sliding bars that hold the film at the middle of its four sides (section 5.1).
  /// Each bar gets marks at both ends and its middle; 0: only at its middle.
  double bar_mm = 0;
  bool mirror = false;   ///< false: ink side up, seen from above
  bool marks = true;     ///< around the film, where there is space
  std::string job_name;  ///< printed on the page; empty: none
  std::string date;      ///< printed on the page unchanged; empty: none
};

/// The colours of the output.
struct ColourSettings {
  /// Without a profile, true selects plain CMYK (as in ink::make_separation), false selects sRGB.
  bool cmyk = false;
  std::filesystem::path icc_profile;  ///< profile of the printer; selects CMYK or RGB
  /// The largest C + M + Y + K of a pixel, above 0 and at most 4; CMYK only.
  double ink_limit = 4;
};

/// Parses "A4", "A3", "letter" or "WxH" (mm). Errors: kInvalidArgument for other texts, kOutOfRange
/// for sides below 10 mm or above 2000 mm.
[[nodiscard]] Result<Eigen::Vector2d> parse_paper(const std::string& text);

/// Returns kOutOfRange, naming the setting, for values out of range and settings that contradict
/// each other.
[[nodiscard]] Status check(const PageSettings& settings);

}  // namespace hydroprint::print
