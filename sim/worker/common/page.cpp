#include "sim/worker/common/page.h"

#include "sim/worker/common/report_values.h"

namespace hydroprint::worker {

void add_page_flags(Flags& flags) {
  flags.add("paper", "Paper: A4, A3, letter or WxH (mm)", {.default_value = "A4", .type = "PAPER"});
  flags.add("printer_margin_mm", "Margin of the paper that the printer cannot reach",
            {.default_value = default_text(print::PageSettings{}.printer_margin_mm)});
  flags.add("job_name", "Job name to print beside the film, as given");
  flags.add("date", "Date to print beside the film, as given");
}

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
