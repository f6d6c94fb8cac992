#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>

#include "daemon/store/job_store.h"
#include "daemon/store/state_layout.h"

namespace hydroprint::v1 {
class PrintImageReport;
class PrintSpec;
}  // namespace hydroprint::v1

namespace hydroprint::daemon {

/// The document to print, and the paper.
struct PrintPlan {
  std::string print_image_job;  ///< "jobs/7"
  std::filesystem::path pdf;
  std::string sha256;  ///< hash of the PDF
  int pages = 1;
  Eigen::Vector2d paper_mm = {210, 297};  ///< the shorter side first, as in the tray
  double margin_mm = 0;                   ///< the printer's margin, as assumed by print-image
};

/// Takes the number of pages, the paper size and the margin from a print-image job's untrusted
/// report.
/// @return kFailedPrecondition, STATE_FORBIDS
[[nodiscard]] Status read_printed_pages(const v1::PrintImageReport& report, PrintPlan& plan);

/// Creates the plan of a spec.
/// @return SPEC_INVALID, ID_INVALID, JOB_NOT_FOUND; STATE_FORBIDS if the print-image job did not
///         succeed, or has no PDF or no usable report
[[nodiscard]] Result<PrintPlan> print_plan_of(const v1::PrintSpec& spec, JobStore& jobs,
                                              const Layout& layout);

}  // namespace hydroprint::daemon
