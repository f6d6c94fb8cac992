#include "daemon/printing/plan.h"

#include <algorithm>

#include "daemon/jobs/referenced_job.h"
#include "daemon/platform/resource_names.h"
#include "hydroprint/v1/spec.pb.h"

namespace hydroprint::daemon {
namespace {

constexpr const char* kPdf = "print.pdf";
constexpr double kLongest_mm = 5000;

bool is_length(double mm) { return mm >= 0 && mm <= kLongest_mm; }

}  // namespace

Status read_printed_pages(const v1::PrintImageReport& report, PrintPlan& plan) {
  const auto size_mm = report.sheets().empty() ? google::protobuf::RepeatedField<double>()
                                               : report.sheets(0).size_mm();
  const bool has_size = size_mm.size() == 2 && is_length(size_mm[0]) && is_length(size_mm[1]) &&
                        size_mm[0] * size_mm[1] > 0;
  if (!has_size || !is_length(report.page().printer_margin_mm())) {
    return fail(
        Code::kFailedPrecondition,
        plan.print_image_job + ": its report does not describe the pages; run print-image again",
        ErrorReason::STATE_FORBIDS);
  }
  plan.pages = report.sheets_size();
  plan.margin_mm = report.page().printer_margin_mm();
  plan.paper_mm = {std::min(size_mm[0], size_mm[1]), std::max(size_mm[0], size_mm[1])};
  return {};
}

Result<PrintPlan> print_plan_of(const v1::PrintSpec& spec, JobStore& jobs, const Layout& layout) {
  HP_ASSIGN_OR_RETURN(const Job job, earlier_job(spec.print_image_job(), "print-image",
                                                 "print.print_image_job", jobs));
  const auto pdf = jobs.artifact(job.id, kPdf);
  if (!pdf) {
    return fail(Code::kFailedPrecondition,
                job_name(job.id) + " has no PDF; run print-image with the format pdf",
                ErrorReason::STATE_FORBIDS);
  }
  PrintPlan plan;
  plan.print_image_job = job_name(job.id);
  plan.pdf = layout.artifacts(job.id) / kPdf;
  plan.sha256 = pdf->sha256;
  HP_ASSIGN_OR_RETURN(const v1::JobReport report, report_of(job, jobs, layout));
  HP_RETURN_IF_ERROR(read_printed_pages(report.print_image(), plan));
  return plan;
}

}  // namespace hydroprint::daemon
