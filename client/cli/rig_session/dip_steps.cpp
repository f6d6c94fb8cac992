#include "client/cli/rig_session/dip_steps.h"

#include <iostream>

#include "client/cli/format/json.h"
#include "client/cli/terminal/console.h"
#include "client/dip.h"
#include "client/name_of.h"
#include "proto/warning_message.h"

namespace hydroprint::cli {

void print_dip(const Program& program, const v1::Job& job) {
  if (program.json()) return print(job);
  if (job.name().empty()) {  // only validated
    std::cout << "The dip is valid." << std::endl;
    return;
  }
  std::cout << job.name() << "\n";
  if (job.has_dip_status()) {
    const std::string step = client::name_of(job.dip_status().step());
    for (const v1::Warning& warning : job.dip_status().warnings())
      std::cout << "warning: " << hydroprint::text_of(warning) << "\n";
    std::cout << step << ": " << printable(client::instruction_of(job.dip_status())) << "\n";
    if (client::waits_for_operator(job.dip_status().step()))
      std::cout << "then: hydroprint confirm " << job.name() << " " << step << "\n";
  }
  std::cout << std::flush;
}

}  // namespace hydroprint::cli
