#include <unistd.h>

#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "client/cli/commands/commands.h"
#include "client/cli/format/json.h"
#include "client/cli/job_io/dip_record.h"
#include "client/cli/job_io/field_help.h"
#include "client/cli/job_io/spec_fields.h"
#include "client/cli/job_io/wait.h"
#include "client/cli/program/program.h"
#include "client/cli/rig_session/dip_guide.h"
#include "client/cli/rig_session/dip_steps.h"
#include "client/cli/rig_session/held_lease.h"
#include "client/cli/terminal/console.h"
#include "client/cli/terminal/terminal.h"
#include "client/jobs.h"

namespace hydroprint::cli {
namespace {

struct DipOptions {
  v1::DipSpec spec;
  client::JobOptions job;
  std::string simulate_job, calibration, out;
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

// On Ctrl-C the daemon aborts the dip; waits until it has.
Result<v1::Job> abort_dip(const Program& program, const std::string& job) {
  client::Connection daemon = program.uninterrupted();
  HP_RETURN_IF_ERROR(client::cancel_job(daemon, job));
  return client::watch_job(daemon, job, [](const v1::WatchJobResponse&) {});
}

Result<v1::Job> follow(Program& program, const HeldLease& lease, const v1::Job& job) {
  if (!job.dip().yes_to_all()) return guide(program, lease, job);
  return follow_job(program, job.name(), {});
}

// Guides or follows the dip to its end; aborts it on Ctrl-C.
Result<v1::Job> go_through(Program& program, const HeldLease& lease, const v1::Job& job) {
  auto ended = follow(program, lease, job);
  if (ended || ended.error().code != Code::kCancelled) return ended;
  if (!program.is_interrupted()) return ended;  // the terminal was closed
  std::cerr << "aborting " << job.name() << std::endl;
  return abort_dip(program, job.name());
}

void tell(const Program& program, const v1::Job& job, const std::vector<Downloaded>& files) {
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
  tell(program, job, files);
  if (job.state() == v1::Job::SUCCEEDED) return {};
  return tl::unexpected(why(job));
}

Status dip(Program& program, DipOptions options) {
  HP_RETURN_IF_ERROR(check_terminal(options));
  options.spec.set_simulate_job(job_name(options.simulate_job));
  options.spec.set_calibration(calibration_name(options.calibration));
  HP_ASSIGN_OR_RETURN(const auto lease,
                      HeldLease::take_or_acquire(program, purpose_of(options.spec)));
  HP_ASSIGN_OR_RETURN(const v1::Job job,
                      client::create_dip(program.daemon(), options.spec, lease->id(), options.job));
  if (options.job.validate_only || options.no_guide) {
    if (options.no_guide) lease->leave();
    print_dip(program, job);
    return {};
  }
  auto ended = go_through(program, *lease, job);
  if (!ended) {  // the dip continues and may need confirmations
    lease->leave();
    return tl::unexpected(std::move(ended).error());
  }
  return finish(program, *ended, options);
}

void add_film_flags(CLI::App& command, v1::DipSpec& spec) {
  add_field(
      command, "--film-area-mm2", spec, "film_area_mm2",
      field_help(
          "DipSpec.film_area_mm2",
          "Area of the film, for the amount of activator; default: from the simulation, or A4"))
      ->type_name("MM2");
  add_field(command, "--activator-ml-per-m2", spec, "activator_ml_per_m2",
            field_help("DipSpec.activator_ml_per_m2",
                       "Amount of activator; default: from the film profile, if any"))
      ->type_name("ML/M2");
  add_field(command, "--soak-s", spec, "soak_s",
            field_help("DipSpec.soak_s",
                       "Time that the film floats before the activator; default: from the "
                       "profile, if any"))
      ->type_name("S");
  add_field(command, "--activator-wait-s", spec, "activator_wait_s",
            field_help("DipSpec.activator_wait_s",
                       "Time that the activator works before the dip; default: from the "
                       "profile, if any"))
      ->type_name("S");
  add_field(
      command, "--activation-window-s", spec, "activation_window_s",
      field_help("DipSpec.activation_window_s", "Time after that in which the film can be dipped"))
      ->type_name("S");
  add_field(command, "--water-temperature-c", spec, "water_temperature_c",
            field_help("DipSpec.water_temperature_c", "Temperature of the water, for the record"))
      ->type_name("C");
}

void add_motion_flags(CLI::App& command, v1::DipSpec& spec) {
  add_field(
      command, "--depth-mm", spec, "depth_mm",
      field_help("DipSpec.depth_mm", "Depth below first contact; default: from the simulation"))
      ->type_name("MM");
  add_field(command, "--speed", spec, "speed_mm_per_s",
            field_help("DipSpec.speed_mm_per_s",
                       "Speed of the descent; default: from the simulation, if any"))
      ->type_name("MM/S");
  add_field(command, "--retract-speed", spec, "retract_speed_mm_per_s",
            field_help("DipSpec.retract_speed_mm_per_s",
                       "Speed of the retraction; default: that of the descent"))
      ->type_name("MM/S");
  add_field(command, "--hold-s", spec, "hold_s",
            field_help("DipSpec.hold_s", "Time that the object stays at the depth"))
      ->type_name("S");
  add_field(command, "--clearance-mm", spec, "clearance_mm",
            field_help("DipSpec.clearance_mm", "Height above the water at which the object waits"))
      ->type_name("MM");
}

constexpr char kDipFooter[] =
    "Needs an armed and homed rig. Acquires the lease ('hydroprint rig lease') unless you have it, "
    "and\n"
    "keeps it during the dip. On a terminal it shows each step, the instruction and the timer;\n"
    "Enter confirms a step. To find first contact, hold Down or j, Up or k (see\n"
    "'hydroprint rig jog --help'). Ctrl-C aborts the dip and prints what to do with film and "
    "object.\n"
    "If this program is lost, the dip continues; resume with 'hydroprint watch JOB' and\n"
    "'hydroprint confirm JOB STEP'.\n\n"
    "Examples:\n"
    "  hydroprint dip --simulate-job 7 --water-temperature-c 24 --out record\n"
    "  hydroprint dip --depth-mm 20 --yes-to-all\n"
    "  hydroprint dip --simulate-job 7 --no-guide && hydroprint confirm 8 PRINT_FILM";

}  // namespace

void add_dip(CLI::App& app, Program& program) {
  auto options = std::make_shared<DipOptions>();
  CLI::App* command = app.add_subcommand("dip", "Dip an object, step by step");
  command
      ->add_option(
          "--simulate-job", options->simulate_job,
          "The simulation whose film image was printed: jobs/7, or 7; gives depth and speed")
      ->type_name("JOB");
  command
      ->add_option("--calibration", options->calibration,
                   "Pose and first contact of the object: calibrations/3, 3 or active; default: "
                   "that of the simulation")
      ->type_name("CALIBRATION");
  add_stale_flag(*command, options->spec);
  add_motion_flags(*command, options->spec);
  add_film_flags(*command, options->spec);
  command->add_option("--name", options->job.display_name, "Display name of the job")
      ->type_name("TEXT");
  command->add_option("--out", options->out, "Download the dip's record into this folder")
      ->type_name("DIR");
  command->add_flag("--no-guide", options->no_guide,
                    "Create the dip and return; you keep the lease");
  add_field(*command, "--yes-to-all", options->spec, "yes_to_all",
            "Skip confirmations and timers; on the virtual rig only");
  command->add_flag("--validate-only", options->job.validate_only, "Check, but create nothing");
  command->footer(kDipFooter);
  program.on(*command, [&program, options] { return dip(program, *options); });
}

}  // namespace hydroprint::cli
