#include "sim/worker/common/page.h"

#include "sim/worker/common/report_values.h"

namespace hydroprint::worker {

Status set_paper(print::PageSettings& page, const std::string& paper) {
  HP_ASSIGN_OR_RETURN(page.paper_mm, print::parse_paper(paper));
  return {};
}

Json page_parameters_json(const print::PageSettings& page, const film::Outline& outline,
                          int threads) {
  return {{"film", film_json(outline)},
          {"paper_mm", pair_of(page.paper_mm)},
          {"printer_margin_mm", page.printer_margin_mm},
          {"job_name", page.job_name},
          {"date", page.date},
          {"threads", threads}};
}

}  // namespace hydroprint::worker
