#include "client/cli/rig_session/run_dip.h"

#include <iostream>
#include <utility>
#include <vector>

#include "client/cli/format/json.h"
#include "client/cli/job_io/dip_record.h"
#include "client/cli/job_io/wait.h"
#include "client/cli/rig_session/dip_guide.h"
#include "client/cli/rig_session/dip_steps.h"
#include "client/cli/rig_session/held_lease.h"
#include "client/cli/rig_session/stop_alarm.h"
#include "client/cli/terminal/terminal.h"

namespace hydroprint::cli {
namespace {

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

void print_result(const Program& program, client::Connection& daemon, const v1::Job& job,
                  const std::vector<Downloaded>& files) {
  if (program.json()) {
    Json json = to_json(job);
    json["files"] = files_json(files);
    print(json);
    return;
  }
  for (const Downloaded& file : files) std::cout << file.path.string() << "\n";
  if (job.state() == v1::Job::SUCCEEDED) {
    const v1::JobReport report = client::job_report(daemon, job.name()).value_or(v1::JobReport());
    std::cout << dip_summary(job.name(), report.dip()) << "\n";
  }
  std::cout << std::flush;
}

Status finish(const Program& program, const v1::Job& job, const DipOptions& options) {
  client::Connection daemon = program.uninterrupted();
  std::vector<Downloaded> files;
  if (!options.out.empty()) {
    HP_ASSIGN_OR_RETURN(files, fetch_record(daemon, job.name(), options.out));
  }
  print_result(program, daemon, job, files);
  if (job.state() == v1::Job::SUCCEEDED) return {};
  return tl::unexpected(why(job));
}

Status carry_out(Program& program, HeldLease& lease, const v1::Job& job,
                 const DipOptions& options) {
  if (options.job.validate_only || options.no_guide) {
    if (options.no_guide) lease.leave();
    print_dip(program, job);
    return {};
  }
  StopAlarm alarm;
  auto ended = go_through(program, lease, job, alarm);
  alarm.look(program);
  if (!ended) {  // the dip continues and may need confirmations
    lease.leave();
    return tl::unexpected(std::move(ended).error());
  }
  return finish(program, *ended, options);
}

}  // namespace

Status run_dip(Program& program, const DipOptions& options) {
  HP_RETURN_IF_ERROR(check_terminal(options));
  HP_ASSIGN_OR_RETURN(const auto lease,
                      HeldLease::take_or_acquire(program, purpose_of(options.spec)));
  HP_ASSIGN_OR_RETURN(const v1::Job job,
                      client::create_dip(program.daemon(), options.spec, lease->id(), options.job));
  return carry_out(program, *lease, job, options);
}

Status resume_dip(Program& program, const std::string& name, DipOptions options) {
  HP_ASSIGN_OR_RETURN(const v1::Job job, client::get_job(program.daemon(), name));
  options.spec = job.dip();
  if (job.dip().yes_to_all()) {
    HP_ASSIGN_OR_RETURN(const v1::Job ended, wait_for(program, name, {}));
    return finish(program, ended, options);
  }
  HP_RETURN_IF_ERROR(check_terminal(options));
  HP_ASSIGN_OR_RETURN(const auto lease,
                      HeldLease::take_or_acquire(program, purpose_of(options.spec)));
  return carry_out(program, *lease, job, options);
}

}  // namespace hydroprint::cli
