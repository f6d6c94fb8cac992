#include <memory>

#include "client/cli/commands/commands.h"
#include "client/cli/job_io/spec_fields.h"
#include "client/cli/program/program.h"
#include "client/cli/rig_session/run_dip.h"

namespace hydroprint::cli {
namespace {

constexpr char kDipFooter[] =
    "Needs an armed and homed rig. Acquires the lease ('hydroprint rig lease') unless you\n"
    "have it, and keeps it during the dip. On a terminal, this command shows each step with\n"
    "its instruction and timer; Enter confirms a step. To find first contact, hold Down or j\n"
    "to go down, Up or k to go up (see 'hydroprint rig jog --help'). Ctrl-C aborts the dip\n"
    "and prints what to do with film and object. If this command ends unexpectedly, the dip\n"
    "continues; resume with 'hydroprint watch JOB' and 'hydroprint confirm JOB STEP'.\n\n"
    "Examples:\n"
    "  hydroprint dip --simulate-job 7 --water-temperature-c 24 --out record\n"
    "  hydroprint dip --depth-mm 20 --yes-to-all\n"
    "  hydroprint dip --simulate-job 7 --no-guide && hydroprint confirm 8 PRINT_FILM";

}  // namespace

void add_dip(CLI::App& app, Program& program) {
  auto options = std::make_shared<DipOptions>();
  CLI::App* command = app.add_subcommand("dip", "Dip an object, step by step");
  add_fields(*command, options->spec);
  command->add_option("--name", options->job.display_name, "Display name of the job")
      ->type_name("TEXT");
  command->add_option("--out", options->out, "Download the dip's record into this folder")
      ->type_name("DIR");
  command->add_flag("--no-guide", options->no_guide,
                    "Create the dip and return; you keep the lease");
  command->add_flag("--validate-only", options->job.validate_only, "Check, but create nothing");
  command->footer(kDipFooter);
  program.on(*command, [&program, options] { return run_dip(program, *options); });
}

}  // namespace hydroprint::cli
