#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "client/loop/measure.h"

namespace hydroprint::loop {

/// All that a report tells.
struct Report {
  std::string object;  ///< the sample
  double bound_mm = 0;
  std::uint32_t seed = 0;
  std::string camera;  ///< the calibration of its lens, or the file
  std::vector<Round> rounds;
};

/// report.json.
[[nodiscard]] std::string report_json(const Report& report);

/// report.html: the same for people, with the rounds' pictures.
[[nodiscard]] std::string report_html(const Report& report);

/// The few lines that a terminal gets.
[[nodiscard]] std::string report_text(const Report& report);

}  // namespace hydroprint::loop
