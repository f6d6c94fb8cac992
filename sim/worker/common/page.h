#pragma once

#include "sim/film/outline.h"
#include "sim/print/settings.h"
#include "sim/worker/common/flags.h"
#include "sim/worker/common/report.h"

// Page options that print-image and template share. For inclusion in .cpp files only.
namespace hydroprint::worker {

/// Sets the paper size. Fails as print::parse_paper() does.
[[nodiscard]] Status set_paper(print::PageSettings& page, const std::string& paper);

template <class Spec>
Result<print::PageSettings> page_settings(const Spec& spec) {
  print::PageSettings out;
  if (spec.has_paper()) HP_RETURN_IF_ERROR(set_paper(out, spec.paper()));
  if (spec.has_printer_margin_mm()) out.printer_margin_mm = spec.printer_margin_mm();
  out.job_name = spec.job_name();
  out.date = spec.date();
  return out;
}

/// Returns the page's part of the parameters in report.json.
[[nodiscard]] Json page_parameters_json(const print::PageSettings& page,
                                        const film::Outline& outline, int threads);

}  // namespace hydroprint::worker
