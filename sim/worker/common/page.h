#pragma once

#include "sim/film/outline.h"
#include "sim/print/settings.h"
#include "sim/worker/common/flags.h"
#include "sim/worker/common/report.h"

namespace hydroprint::v1 {
class PageFacts;
}  // namespace hydroprint::v1

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

void set_page(const print::PageSettings& page, const film::Outline& outline, v1::PageFacts& out);

}  // namespace hydroprint::worker
