#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "client/loop/measure.h"
#include "sim/base/result.h"

namespace hydroprint::loop {

/// The contents of a report.
struct Report {
  std::string object;  ///< name of the sample
  double bound_mm = 0;
  std::uint32_t seed = 0;
  std::string camera;  ///< name of the camera calibration, or its file
  std::vector<Round> rounds;
};

/// Returns kAborted with the figures if the print is worse than its limit.
[[nodiscard]] Status verdict(const Report& report);

/// Returns the content of report.json.
[[nodiscard]] std::string report_json(const Report& report);

/// Returns report.html, the report with the pictures of all rounds.
[[nodiscard]] std::string report_html(const Report& report);

/// Returns the summary for the terminal.
[[nodiscard]] std::string report_text(const Report& report);

}  // namespace hydroprint::loop
