#include "daemon/printing/record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace hydroprint::daemon {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr double kSamePaper_mm = 0.5;
constexpr double kSameMargin_mm = 0.05;

OrderedJson news_json(const std::vector<PrinterNews>& news) {
  OrderedJson out = OrderedJson::array();
  for (const PrinterNews& item : news) {
    out.push_back({{"time_s", item.time_s},
                   {"state", printer::job_state_name(item.report.state)},
                   {"reasons", item.report.reasons},
                   {"printer_reasons", item.report.printer_reasons},
                   {"pages_done", item.report.pages_done}});
  }
  return out;
}

OrderedJson warnings_json(const Warnings& warnings) {
  OrderedJson out = OrderedJson::array();
  for (const Warning& warning : warnings) {
    out.push_back({{"code", warning.code}, {"message", warning.message}, {"where", warning.where}});
  }
  return out;
}

bool has_paper(const printer::Attributes& printer, const Eigen::Vector2d& size_mm) {
  return std::any_of(printer.papers.begin(), printer.papers.end(), [&](const auto& paper) {
    return (paper.size_mm - size_mm).cwiseAbs().maxCoeff() <= kSamePaper_mm;
  });
}

}  // namespace

std::string report_json(const PrintFacts& facts) {
  const PrintPlan& plan = facts.plan;
  const OrderedJson out = {
      {"verb", "print"},
      {"job", facts.job},
      {"create_time", facts.create_time},
      {"print_image_job", plan.print_image_job},
      {"document",
       {{"sha256", plan.sha256},
        {"pages", plan.pages},
        {"paper_mm", {plan.paper_mm.x(), plan.paper_mm.y()}}}},
      {"printer",
       {{"address", facts.address},
        {"name", facts.printer.name},
        {"make_and_model", facts.printer.make_and_model},
        {"job", facts.news.empty() ? OrderedJson() : OrderedJson(facts.news.back().report.id)}}},
      {"states", news_json(facts.news)},
      {"outcome", facts.outcome},
      {"reason", facts.reason},
      {"message", facts.message},
      {"warnings", warnings_json(facts.warnings)}};
  return out.dump(2, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

Warnings warnings_of(const PrintPlan& plan, const printer::Attributes& printer) {
  Warnings out;
  if (!printer.papers.empty() && !has_paper(printer, plan.paper_mm)) {
    out.push_back({"paper_not_listed",
                   fmt::format("the printer does not list paper of {:g} x {:g} mm; set up this "
                               "size at the printer, and measure the rulers on the printed page",
                               plan.paper_mm.x(), plan.paper_mm.y()),
                   "printer"});
  }
  const double margin_mm = printer.margins_mm.maxCoeff();
  if (margin_mm > plan.margin_mm + kSameMargin_mm) {
    out.push_back(
        {"printer_margin",
         fmt::format("the printer cannot print the outer {:g} mm of the paper, but print-image "
                     "assumed a margin of {:g} mm; the difference is not printed. Run print-image "
                     "with the printer's margin (--printer-margin-mm)",
                     margin_mm, plan.margin_mm),
         plan.print_image_job});
  }
  return out;
}

Warnings warnings_of(const std::vector<std::string>& ignored) {
  Warnings out;
  for (const std::string& name : ignored) {
    const bool is_scale = name == "print-scaling";
    out.push_back({is_scale ? "scale_not_heeded" : "not_heeded",
                   fmt::format("the printer ignores {}{}; measure the rulers on the printed page",
                               name, is_scale ? ": it may not print at exact scale" : ""),
                   "printer"});
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
                "FORMAT_NOT_SUPPORTED");
  }
  if (!printer.accepts_jobs) {
    const auto& why = printer.state_reasons;
    return fail(Code::kFailedPrecondition,
                fmt::format("printer {}: does not accept jobs{}. Check its display", address,
                            why.empty() ? "" : fmt::format(" ({})", fmt::join(why, ", "))),
                "PRINTER_REFUSED");
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
