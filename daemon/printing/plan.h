#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>

#include "daemon/store/job_store.h"
#include "daemon/store/state_layout.h"

namespace hydroprint::v1 {
class PrintSpec;
}

namespace hydroprint::daemon {

/// What is to be printed, and on what.
struct PrintPlan {
  std::string print_image_job;  ///< "jobs/7"
  std::filesystem::path pdf;
  std::string sha256;  ///< of the PDF
  int pages = 1;
  Eigen::Vector2d paper_mm = {210, 297};  ///< the shorter side first, as it lies in the tray
  double margin_mm = 0;                   ///< what print-image was told the printer leaves free
};

/// What a print-image job's report.json says of its pages, trusting nothing in it.
/// @return kFailedPrecondition, STATE_FORBIDS
[[nodiscard]] Status read_printed_pages(const std::string& report, PrintPlan& plan);

/// The plan of a spec.
/// @return SPEC_INVALID, ID_INVALID, JOB_NOT_FOUND; STATE_FORBIDS if that job did not succeed, made
///   no PDF or left no usable report
[[nodiscard]] Result<PrintPlan> print_plan_of(const v1::PrintSpec& spec, JobStore& jobs,
                                              const Layout& layout);

}  // namespace hydroprint::daemon
