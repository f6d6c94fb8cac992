#include "client/cli/plan/progress_text.h"

#include <fmt/format.h>

#include "client/cli/terminal/console.h"
#include "client/dip.h"
#include "client/name_of.h"
#include "proto/warning_message.h"

namespace hydroprint::cli {
namespace {

std::string state_of(const v1::PlanProgress::Dip& dip) {
  switch (dip.step()) {
    case v1::PlanProgress::CALIBRATE:
      return "calibrate";
    case v1::PlanProgress::SIMULATE:
      return "compute the film";
    case v1::PlanProgress::LAY_OUT:
      return "lay out the film";
    case v1::PlanProgress::DIP:
      return "print and dip";
    case v1::PlanProgress::WAIT:
      return "waiting for " + dip.job();
    case v1::PlanProgress::CONFIRM:
      return "confirm steps of " + dip.job();
    case v1::PlanProgress::DONE:
      return "done";
    default:
      return client::name_of(dip.step());
  }
}

std::string notes_of(const v1::PlanProgress::Dip& dip, const std::string& indent) {
  std::string out;
  if (!dip.trouble().empty()) out += fmt::format("{}note: {}\n", indent, printable(dip.trouble()));
  for (const v1::Warning& warning : dip.warnings())
    out += fmt::format("{}warning: {}\n", indent, hydroprint::text_of(warning));
  return out;
}

std::string instruction_of(const v1::PlanProgress::Dip& dip, int count) {
  return client::which_dip(dip.immersion(), count) + printable(dip.instruction());
}

std::string number_of(const std::string& job) { return job.substr(job.find('/') + 1); }

}  // namespace

std::string table_of(const v1::PlanProgress& progress) {
  const auto row = [](const auto& number, const std::string& state, const std::string& simulate,
                      const std::string& pages, const std::string& dip) {
    return fmt::format("{:<5}{:<28}{:<12}{:<13}{}\n", number, state, simulate, pages, dip);
  };
  std::string out = row("DIP", "STATE", "SIMULATE", "PRINT-IMAGE", "DIP JOB");
  for (const v1::PlanProgress::Dip& dip : progress.dips()) {
    out += row(dip.immersion(), state_of(dip), dip.simulate_job(), dip.print_image_job(),
               dip.dip_job());
    out += notes_of(dip, "     ");
  }
  return out;
}

std::string next_text(const v1::PlanProgress& progress) {
  const int count = progress.dips_size(), next = progress.next_immersion();
  if (next == 0)
    return count == 1 ? "the dip is done\n" : fmt::format("all {} dips are done\n", count);
  std::string out = fmt::format("next: hydroprint plan next {}\n", number_of(progress.plan_job()));
  if (next <= count) out += "  " + instruction_of(progress.dips(next - 1), count) + "\n";
  return out;
}

std::string step_text(const v1::PlanProgress::Dip& dip, int count) {
  return instruction_of(dip, count) + "\n" + notes_of(dip, "  ");
}

}  // namespace hydroprint::cli
