#include <iostream>
#include <memory>
#include <string>

#include "client/cli/commands/commands.h"
#include "client/cli/program/program.h"
#include "client/cli/rig_session/dip_steps.h"
#include "client/cli/rig_session/held_lease.h"
#include "client/dip.h"
#include "client/jobs.h"

namespace hydroprint::cli {
namespace {

struct ConfirmOptions {
  std::string job, step, with_lease;
};

Status confirm(Program& program, const ConfirmOptions& options) {
  HP_ASSIGN_OR_RETURN(const auto lease, HeldLease::take(program, options.with_lease));
  v1::DipStatus::Step step = v1::DipStatus::STEP_UNSPECIFIED;
  v1::DipStatus::Step_Parse(options.step, &step);
  HP_ASSIGN_OR_RETURN(
      const v1::Job job,
      client::confirm_step(program.daemon(), job_name(options.job), step, lease->id()));
  print_dip(program, job);
  return {};
}

}  // namespace

void add_confirm(CLI::App& app, Program& program) {
  auto options = std::make_shared<ConfirmOptions>();
  CLI::App* command =
      app.add_subcommand("confirm", "Confirm a step of a dip, so that it continues");
  add_job_argument(*command, options->job);
  command->add_option("step", options->step, "The completed step")
      ->type_name("STEP")
      ->required()
      ->transform(CLI::IsMember(client::operator_steps(), CLI::ignore_case));
  add_lease_flag(*command, options->with_lease);
  command->footer(
      "Needs the current lease, which may be newer than the one that created the dip.\n"
      "'hydroprint show JOB' shows the step. Confirming a step again has no effect.\n\n"
      "Example:\n"
      "  hydroprint confirm 8 LAY_FILM");
  program.on(*command, [&program, options] { return confirm(program, *options); });
}

}  // namespace hydroprint::cli
