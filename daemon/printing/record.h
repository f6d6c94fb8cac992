#pragma once

#include <string>
#include <vector>

#include "daemon/printing/plan.h"
#include "hardware/printer/printer.h"
#include "sim/base/result.h"

namespace hydroprint::daemon {

/// What the printer said when.
struct PrinterNews {
  double time_s = 0;  ///< since the job was created
  printer::JobReport report;
};

/// What report.json of a print says.
struct PrintFacts {
  std::string job;  ///< "jobs/8"
  std::string create_time;
  PrintPlan plan;
  std::string address;
  printer::Attributes printer;
  std::vector<PrinterNews> news;
  Warnings warnings;
  std::string outcome;  ///< "SUCCEEDED"
  std::string reason;   ///< of a failure
  std::string message;
};

/// JSON of a report, one object.
[[nodiscard]] std::string report_json(const PrintFacts& facts);

/// What speaks against sending the plan to a printer, though not against trying.
[[nodiscard]] Warnings warnings_of(const PrintPlan& plan, const printer::Attributes& printer);

/// The same of what the printer said it would not heed of a job.
[[nodiscard]] Warnings warnings_of(const std::vector<std::string>& ignored);

/// Refuses (FORMAT_NOT_SUPPORTED, PRINTER_REFUSED) what a printer says it would refuse.
[[nodiscard]] Status check_takes_pdf(const printer::Attributes& printer,
                                     const std::string& address);

/// "processing", "stopped: printer-stopped, media-empty": a printer's news on one line.
[[nodiscard]] std::string words_of(const printer::JobReport& report);

}  // namespace hydroprint::daemon
