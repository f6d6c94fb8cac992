#pragma once

#include <string>
#include <vector>

#include "daemon/printing/plan.h"
#include "hardware/printer/printer.h"
#include "hydroprint/v1/report.pb.h"
#include "sim/base/result.h"

namespace hydroprint::daemon {

/// A status report of the printer, with its time.
struct PrinterNews {
  double time_s = 0;  ///< since the job was created
  printer::JobReport report;
};

/// Content of a print's report.json.
struct PrintFacts {
  std::string job;  ///< "jobs/8"
  std::string create_time;
  PrintPlan plan;
  std::string address;
  printer::Attributes printer;
  std::vector<PrinterNews> news;
  Warnings warnings;
  std::string outcome;   ///< "SUCCEEDED"
  ErrorReason reason{};  ///< only after a failure
  std::string message;
};

/// Returns the content of report.json.
[[nodiscard]] v1::PrintReport report_of(const PrintFacts& facts);

/// Returns reasons to expect a poor print on this printer.
[[nodiscard]] Warnings warnings_of(const PrintPlan& plan, const printer::Attributes& printer);

/// Returns warnings about job attributes that the printer ignores.
[[nodiscard]] Warnings warnings_of(const std::vector<std::string>& ignored);

/// Returns FORMAT_NOT_SUPPORTED or PRINTER_REFUSED if the printer cannot accept the job.
[[nodiscard]] Status check_takes_pdf(const printer::Attributes& printer,
                                     const std::string& address);

/// Formats a status report on one line: "processing", "stopped: printer-stopped, media-empty".
[[nodiscard]] std::string words_of(const printer::JobReport& report);

}  // namespace hydroprint::daemon
