#include "daemon/printing/record.h"

#include <fmt/format.h>

#include <algorithm>

#include "proto/warning_message.h"
#include "sim/base/utf8.h"

namespace hydroprint::daemon {
namespace {

constexpr double kSamePaper_mm = 0.5;
constexpr double kSameMargin_mm = 0.05;

void add_state(const PrinterNews& news, v1::PrintReport& out) {
  v1::PrintReport::PrinterState& state = *out.add_states();
  state.set_time_s(news.time_s);
  state.set_state(printer::job_state_name(news.report.state));
  for (const std::string& reason : news.report.reasons) state.add_reasons(one_line(reason));
  for (const std::string& reason : news.report.printer_reasons)
    state.add_printer_reasons(one_line(reason));
  state.set_pages_done(news.report.pages_done);
}

bool has_paper(const printer::Attributes& printer, const Eigen::Vector2d& size_mm) {
  return std::any_of(printer.papers.begin(), printer.papers.end(), [&](const auto& paper) {
    return (paper.size_mm - size_mm).cwiseAbs().maxCoeff() <= kSamePaper_mm;
  });
}

}  // namespace

v1::PrintReport report_of(const PrintFacts& facts) {
  const PrintPlan& plan = facts.plan;
  v1::PrintReport out;
  out.mutable_run()->set_program("hydroprintd");
  out.mutable_run()->set_version(HYDROPRINT_VERSION);
  out.mutable_run()->set_verb("print");
  add_warnings(facts.warnings, *out.mutable_run()->mutable_warnings());
  out.set_job(facts.job);
  out.set_create_time(facts.create_time);
  out.set_outcome(facts.outcome);
  out.set_reason(static_cast<v1::ErrorReason>(facts.reason));
  out.set_message(one_line(facts.message));
  out.set_print_image_job(plan.print_image_job);
  out.set_sha256(plan.sha256);
  out.set_pages(plan.pages);
  for (const double side_mm : plan.paper_mm) out.add_paper_mm(side_mm);
  out.set_printer_address(facts.address);
  out.set_printer_name(one_line(facts.printer.name));
  out.set_printer_make_and_model(one_line(facts.printer.make_and_model));
  if (!facts.news.empty()) out.set_printer_job(facts.news.back().report.id);
  for (const PrinterNews& news : facts.news) add_state(news, out);
  return out;
}

Warnings warnings_of(const PrintPlan& plan, const printer::Attributes& printer) {
  Warnings out;
  if (!printer.papers.empty() && !has_paper(printer, plan.paper_mm)) {
    out.push_back({WarningCode::PAPER_NOT_LISTED,
                   fmt::format("the printer does not list paper of {:g} x {:g} mm; set up this "
                               "size at the printer, and measure the rulers on the printed page",
                               plan.paper_mm.x(), plan.paper_mm.y()),
                   {OfItem{"printer"}}});
  }
  const double margin_mm = printer.margins_mm.maxCoeff();
  if (margin_mm > plan.margin_mm + kSameMargin_mm) {
    out.push_back(
        {WarningCode::PRINTER_MARGIN,
         fmt::format("the printer cannot print the outer {:g} mm of the paper, but print-image "
                     "assumed a margin of {:g} mm; the difference is not printed. Run print-image "
                     "with the printer's margin (--printer-margin-mm)",
                     margin_mm, plan.margin_mm),
         {OfResource{plan.print_image_job}}});
  }
  return out;
}

Warnings warnings_of(const std::vector<std::string>& ignored) {
  Warnings out;
  for (const std::string& name : ignored) {
    const bool is_scale = name == "print-scaling";
    out.push_back({is_scale ? WarningCode::SCALE_NOT_HEEDED : WarningCode::NOT_HEEDED,
                   fmt::format("the printer ignores {}{}; measure the rulers on the printed page",
                               name, is_scale ? ": it may not print at exact scale" : ""),
                   {OfItem{"printer"}}});
  }
  return out;
}

Status check_takes_pdf(const printer::Attributes& printer, const std::string& address) {
  const auto& formats = printer.formats;
  if (!formats.empty() &&
      std::find(formats.begin(), formats.end(), "application/pdf") == formats.end()) {
    return fail(Code::kInvalidArgument,
                fmt::format("printer {}: does not accept PDF (only {}). Download print.pdf and "
                            "print it from a machine with a driver for it",
                            address, fmt::join(formats, ", ")),
                ErrorReason::FORMAT_NOT_SUPPORTED);
  }
  if (!printer.accepts_jobs) {
    const auto& why = printer.state_reasons;
    return fail(Code::kFailedPrecondition,
                fmt::format("printer {}: does not accept jobs{}. Check its display", address,
                            why.empty() ? "" : fmt::format(" ({})", fmt::join(why, ", "))),
                ErrorReason::PRINTER_REFUSED);
  }
  return {};
}

std::string words_of(const printer::JobReport& report) {
  std::vector<std::string> all = report.reasons;
  all.insert(all.end(), report.printer_reasons.begin(), report.printer_reasons.end());
  return fmt::format("{}{}{}", printer::job_state_name(report.state), all.empty() ? "" : ": ",
                     fmt::join(all, ", "));
}

}  // namespace hydroprint::daemon
