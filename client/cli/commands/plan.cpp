#include <iostream>
#include <memory>
#include <string>

#include "client/cli/commands/commands.h"
#include "client/cli/format/json.h"
#include "client/cli/job_io/spec_fields.h"
#include "client/cli/plan/next_step.h"
#include "client/cli/plan/progress_text.h"
#include "client/cli/program/program.h"
#include "client/jobs.h"

namespace hydroprint::cli {
namespace {

struct PlanOptions {
  std::string job;
  StepOptions step;
};

Status show_plan(Program& program, const std::string& job) {
  HP_ASSIGN_OR_RETURN(const auto progress, client::plan_progress(program.daemon(), job_name(job)));
  if (program.json())
    print(progress);
  else
    std::cout << table_of(progress) << "\n" << next_text(progress) << std::flush;
  return {};
}

Status do_next(Program& program, const PlanOptions& options) {
  const std::string plan = job_name(options.job);
  HP_ASSIGN_OR_RETURN(const auto before, client::plan_progress(program.daemon(), plan));
  HP_RETURN_IF_ERROR(do_next_step(program, before, options.step));
  if (program.json()) return {};
  HP_ASSIGN_OR_RETURN(const auto after, client::plan_progress(program.daemon(), plan));
  std::cout << next_text(after) << std::flush;
  return {};
}

constexpr char kNextFooter[] =
    "Does the next step, and names the one after it. For each dip: measure the pose of the hung "
    "object\n"
    "(with a depth camera), compute the film for that pose, lay it out for the printer, and dip.\n"
    "The dip is guided and needs an armed and homed rig, like 'hydroprint dip'. After a failed\n"
    "step, the same command tries it again. Steps that you do with other commands count as well,\n"
    "for example 'hydroprint submit print-image' with another paper.\n\n"
    "Examples:\n"
    "  hydroprint plan next 7\n"
    "  hydroprint plan next 7 --immersion 2 --out second\n"
    "  hydroprint plan next 7 --yes --yes-to-all     # without questions, on the virtual rig";

void add_plan_show(CLI::App& parent, Program& program) {
  auto job = std::make_shared<std::string>();
  CLI::App* command = parent.add_subcommand("show", "Show the state of each dip and the next step");
  add_job_argument(*command, *job);
  command->footer("Example:\n  hydroprint plan show 7");
  program.on(*command, [&program, job] { return show_plan(program, *job); });
}

void add_plan_next(CLI::App& parent, Program& program) {
  auto options = std::make_shared<PlanOptions>();
  CLI::App* command = parent.add_subcommand("next", "Do the next step of a plan");
  StepOptions& step = options->step;
  add_job_argument(*command, options->job);
  command->add_option("--immersion", step.immersion, "The dip, from 1; default: the next one")
      ->type_name("N")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--out", step.out,
                   "Folder for print.pdf, the picture of the pose and the dip's record; default: "
                   "dip-N")
      ->type_name("DIR");
  command->add_flag("--yes", step.yes, "Calibrate without asking: the object hangs as planned");
  add_field(*command, step.dip, "yes_to_all");
  command->add_flag("--no-guide", step.no_guide, "Create the dip and return; you keep the lease");
  command->footer(kNextFooter);
  program.on(*command, [&program, options] { return do_next(program, *options); });
}

}  // namespace

void add_plan(CLI::App& app, Program& program) {
  CLI::App* command = app.add_subcommand("plan", "Follow a plan of several dips, step by step");
  command->require_subcommand(1);
  add_plan_show(*command, program);
  add_plan_next(*command, program);
}

}  // namespace hydroprint::cli
