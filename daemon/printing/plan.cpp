#include "daemon/printing/plan.h"

#include <algorithm>
#include <cmath>

#include "daemon/jobs/referenced_job.h"
#include "daemon/platform/resource_names.h"
#include "hydroprint/v1/spec.pb.h"
#include "sim/base/checked_json.h"

namespace hydroprint::daemon {
namespace {

constexpr const char* kPdf = "print.pdf";
constexpr double kLongest_mm = 5000;

/// Returns a length in the report, from 0 to the maximum; NaN if missing or out of range.
double length_mm(const nlohmann::json& report, const std::string& pointer) {
  const nlohmann::json::json_pointer place(pointer);
  if (!report.contains(place) || !report.at(place).is_number()) return NAN;
  const double out = report.at(place).get<double>();
  return out >= 0 && out <= kLongest_mm ? out : NAN;
}

}  // namespace

Status read_printed_pages(const std::string& text, PrintPlan& plan) {
  const auto report = parse_json(text, {text.size()}).value_or(nlohmann::json());
  const nlohmann::json::json_pointer sheets("/print/sheets");
  const bool has_sheets = report.contains(sheets) && report.at(sheets).is_array();
  plan.pages = has_sheets ? static_cast<int>(report.at(sheets).size()) : 0;
  const double width_mm = length_mm(report, "/print/sheets/0/size_mm/0");
  const double height_mm = length_mm(report, "/print/sheets/0/size_mm/1");
  plan.margin_mm = length_mm(report, "/parameters/printer_margin_mm");
  if (plan.pages < 1 || !(width_mm > 0) || !(height_mm > 0) || std::isnan(plan.margin_mm)) {
    return fail(Code::kFailedPrecondition,
                plan.print_image_job +
                    ": its report.json does not describe the pages; run "
                    "print-image again",
                "STATE_FORBIDS");
  }
  plan.paper_mm = {std::min(width_mm, height_mm), std::max(width_mm, height_mm)};
  return {};
}

Result<PrintPlan> print_plan_of(const v1::PrintSpec& spec, JobStore& jobs, const Layout& layout) {
  HP_ASSIGN_OR_RETURN(const Job job, earlier_job(spec.print_image_job(), "print-image",
                                                 "print.print_image_job", jobs));
  const auto pdf = jobs.artifact(job.id, kPdf);
  if (!pdf) {
    return fail(Code::kFailedPrecondition,
                job_name(job.id) + " has no PDF; run print-image with the format pdf",
                "STATE_FORBIDS");
  }
  PrintPlan plan;
  plan.print_image_job = job_name(job.id);
  plan.pdf = layout.artifacts(job.id) / kPdf;
  plan.sha256 = pdf->sha256;
  HP_ASSIGN_OR_RETURN(const std::string report, report_of(job, layout));
  HP_RETURN_IF_ERROR(read_printed_pages(report, plan));
  return plan;
}

}  // namespace hydroprint::daemon
