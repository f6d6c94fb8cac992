#include "sim/worker/common/page.h"

#include "hydroprint/v1/report.pb.h"
#include "sim/worker/common/report_values.h"

namespace hydroprint::worker {

Status set_paper(print::PageSettings& page, const std::string& paper) {
  HP_ASSIGN_OR_RETURN(page.paper_mm, print::parse_paper(paper));
  return {};
}

void set_page(const print::PageSettings& page, const film::Outline& outline, v1::PageFacts& out) {
  set_film(outline, *out.mutable_film());
  add_all(page.paper_mm, out.mutable_paper_mm());
  out.set_printer_margin_mm(page.printer_margin_mm);
  out.set_job_name(page.job_name);
  out.set_date(page.date);
}

}  // namespace hydroprint::worker
