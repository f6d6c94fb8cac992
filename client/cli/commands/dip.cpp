#include <unistd.h>

#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "client/cli/commands/commands.h"
#include "client/cli/format/json.h"
#include "client/cli/job_io/dip_record.h"
#include "client/cli/job_io/spec_fields.h"
#include "client/cli/job_io/wait.h"
#include "client/cli/program/program.h"
#include "client/cli/rig_session/dip_guide.h"
#include "client/cli/rig_session/dip_steps.h"
#include "client/cli/rig_session/held_lease.h"
#include "client/cli/rig_session/stop_alarm.h"
#include "client/cli/terminal/console.h"
#include "client/cli/terminal/terminal.h"
#include "client/jobs.h"

namespace hydroprint::cli {
namespace {

struct DipOptions {
  v1::DipSpec spec;
  client::JobOptions job;
  std::string out;
  bool no_guide = false;
};

std::string purpose_of(const v1::DipSpec& spec) {
  return spec.simulate_job().empty() ? "a dip" : "the dip of " + spec.simulate_job();
}

Status check_terminal(const DipOptions& options) {
  if (options.no_guide || options.spec.yes_to_all() || options.job.validate_only ||
      Keyboard::is_there())
    return {};
  return fail(Code::kInvalidArgument,
              "the guide through the steps needs a terminal; use --no-guide and then 'hydroprint "
              "confirm JOB STEP' for each step, or --yes-to-all on the virtual rig");
}

// Cancels the dip after Ctrl-C, and waits until the daemon has aborted it.
Result<v1::Job> abort_dip(const Program& program, const std::string& job) {
  client::Connection daemon = program.uninterrupted();
  HP_RETURN_IF_ERROR(client::cancel_job(daemon, job));
  return client::watch_job(daemon, job, [](const v1::WatchJobResponse&) {});
}

Result<v1::Job> follow(Program& program, const HeldLease& lease, const v1::Job& job,
                       StopAlarm& alarm) {
  if (!job.dip().yes_to_all()) return guide(program, lease, job, alarm);
  return follow_job(program, job.name(), {});
}

// Guides or follows the dip to its end; aborts it on Ctrl-C.
Result<v1::Job> go_through(Program& program, const HeldLease& lease, const v1::Job& job,
                           StopAlarm& alarm) {
  auto ended = follow(program, lease, job, alarm);
  if (ended || ended.error().code != Code::kCancelled) return ended;
  if (!program.is_interrupted()) return ended;  // the terminal was closed, and the dip continues
  std::cerr << "aborting " << job.name() << std::endl;
  return abort_dip(program, job.name());
}

void print_result(const Program& program, const v1::Job& job,
                  const std::vector<Downloaded>& files) {
  if (program.json()) {
    Json json = to_json(job);
    json["files"] = files_json(files);
    print(json);
    return;
  }
  for (const Downloaded& file : files) std::cout << file.path.string() << "\n";
  if (job.state() == v1::Job::SUCCEEDED) std::cout << dip_summary(job, files) << "\n";
  std::cout << std::flush;
}

Status finish(const Program& program, const v1::Job& job, const DipOptions& options) {
  client::Connection daemon = program.uninterrupted();
  std::vector<Downloaded> files;
  if (!options.out.empty()) {
    HP_ASSIGN_OR_RETURN(files, fetch_record(daemon, job.name(), options.out));
  }
  print_result(program, job, files);
  if (job.state() == v1::Job::SUCCEEDED) return {};
  return tl::unexpected(why(job));
}

Status dip(Program& program, const DipOptions& options) {
  HP_RETURN_IF_ERROR(check_terminal(options));
  HP_ASSIGN_OR_RETURN(const auto lease,
                      HeldLease::take_or_acquire(program, purpose_of(options.spec)));
  HP_ASSIGN_OR_RETURN(const v1::Job job,
                      client::create_dip(program.daemon(), options.spec, lease->id(), options.job));
  if (options.job.validate_only || options.no_guide) {
    if (options.no_guide) lease->leave();
    print_dip(program, job);
    return {};
  }
  StopAlarm alarm;
  auto ended = go_through(program, *lease, job, alarm);
  alarm.look(program);
  if (!ended) {  // the dip continues and may need confirmations
    lease->leave();
    return tl::unexpected(std::move(ended).error());
  }
  return finish(program, *ended, options);
}

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
  program.on(*command, [&program, options] { return dip(program, *options); });
}

}  // namespace hydroprint::cli
