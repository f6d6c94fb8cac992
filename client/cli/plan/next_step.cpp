#include "client/cli/plan/next_step.h"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <vector>

#include "client/cli/format/json.h"
#include "client/cli/job_io/calibration.h"
#include "client/cli/job_io/finish.h"
#include "client/cli/job_io/wait.h"
#include "client/cli/plan/progress_text.h"
#include "client/cli/rig_session/run_dip.h"
#include "client/cli/terminal/terminal.h"
#include "client/jobs.h"

namespace hydroprint::cli {
namespace {

constexpr std::size_t kNameMaxBytes = 200;  // of Job.display_name and PrintImageSpec.job_name

// What a person has to read goes to standard error beside --json.
void say(const Program& program, const std::string& text) {
  (program.json() ? std::cerr : std::cout) << text << std::flush;
}

/// Asks for Enter. The keyboard is taken first, because keys pressed before that are lost.
Status wait_for_enter(const Program& program) {
  Keyboard keyboard;
  say(program, "  Enter when it hangs; Ctrl-C ends this command\n");
  while (!program.is_interrupted() && !keyboard.gone()) {
    const auto keys = keyboard.read(std::chrono::milliseconds(100));
    if (std::find(keys.begin(), keys.end(), Key::kEnter) != keys.end()) return {};
  }
  return fail(Code::kCancelled, "interrupted; nothing was captured");
}

/// The steps of one dip.
class DipOfPlan {
 public:
  DipOfPlan(Program& program, const v1::PlanProgress& progress, const v1::PlanProgress::Dip& dip,
            const StepOptions& options)
      : program_(program),
        progress_(progress),
        dip_(dip),
        options_(options),
        out_(options.out.empty() ? fmt::format("dip-{}", dip.immersion()) : options.out) {}

  Status take_step() {
    if (dip_.step() != v1::PlanProgress::DONE)
      say(program_, step_text(dip_, progress_.dips_size()));
    switch (dip_.step()) {
      case v1::PlanProgress::CALIBRATE:
        return calibrate();
      case v1::PlanProgress::SIMULATE:
        return simulate();
      case v1::PlanProgress::LAY_OUT:
        return lay_out();
      case v1::PlanProgress::DIP:
        return dip();
      case v1::PlanProgress::WAIT:
        return follow();
      case v1::PlanProgress::CONFIRM:
        return resume_dip(program_, dip_.job(), dip_options());
      case v1::PlanProgress::DONE:
        if (program_.json()) print(progress_);
        return {};
      default:
        return fail(Code::kUnimplemented, "this program does not know the step; update it");
    }
  }

 private:
  Status calibrate() {
    if (!options_.yes && !Keyboard::is_there())
      return fail(Code::kInvalidArgument,
                  "the object must hang as in the picture before it is calibrated; use --yes once "
                  "it does, or a terminal");
    HP_ASSIGN_OR_RETURN(const v1::Job plan, get_plan());
    show_picture();
    if (!options_.yes) HP_RETURN_IF_ERROR(wait_for_enter(program_));
    v1::Job job;
    v1::CalibrateSpec& spec = *job.mutable_calibrate();
    take_object(plan.plan(), spec);
    HP_ASSIGN_OR_RETURN(*spec.mutable_capture_job(), capture_frames(program_, std::nullopt, {}));
    return run_calibration(program_, job, named(plan), {});
  }

  Status simulate() {
    HP_ASSIGN_OR_RETURN(const v1::Job plan, get_plan());
    v1::Job job;
    v1::SimulateSpec& spec = *job.mutable_simulate();
    spec.set_plan_job(progress_.plan_job());
    spec.set_immersion(dip_.immersion());
    spec.set_calibration(dip_.calibration());
    return run(job, named(plan), {});
  }

  Status lay_out() {
    HP_ASSIGN_OR_RETURN(const v1::Job plan, get_plan());
    const client::JobOptions names = named(plan);
    v1::Job job;
    job.mutable_print_image()->set_simulate_job(dip_.simulate_job());
    job.mutable_print_image()->set_job_name(names.display_name);
    FinishOptions finish;
    finish.out = out_;
    finish.artifacts = {"print.pdf"};
    return run(job, names, finish);
  }

  Status dip() {
    HP_ASSIGN_OR_RETURN(const v1::Job plan, get_plan());
    DipOptions options = dip_options();
    options.spec.set_simulate_job(dip_.simulate_job());
    options.job = named(plan);
    return run_dip(program_, options);
  }

  Status follow() {
    v1::Job job;
    job.set_name(dip_.job());
    return finish_job(program_, job, {});
  }

  Status run(const v1::Job& job, const client::JobOptions& names, const FinishOptions& options) {
    HP_ASSIGN_OR_RETURN(const v1::Job created, client::create_job(program_.daemon(), job, names));
    HP_RETURN_IF_ERROR(finish_job(program_, created, options));
    return program_.json() ? Status() : tell_warnings(program_, created.name());
  }

  Result<v1::Job> get_plan() { return client::get_job(program_.daemon(), progress_.plan_job()); }

  // The new jobs are called for example "my spot, dip 2 of 3".
  client::JobOptions named(const v1::Job& plan) const {
    const std::string dip = fmt::format("dip {} of {}", dip_.immersion(), progress_.dips_size());
    client::JobOptions out;
    out.display_name = plan.display_name() + ", " + dip;
    if (out.display_name.size() > kNameMaxBytes) out.display_name = dip;
    return out;
  }

  DipOptions dip_options() const {
    DipOptions out;
    out.spec = options_.dip;
    out.out = out_;
    out.no_guide = options_.no_guide;
    return out;
  }

  // The files of the film's polygon and of the mesh are among the object's extra files.
  void take_object(const v1::PlanSpec& plan, v1::CalibrateSpec& spec) const {
    *spec.mutable_mesh() = plan.object().mesh();
    *spec.mutable_extra_files() = plan.object().extra_files();
    if (plan.object().has_scale()) spec.set_scale(plan.object().scale());
    if (plan.film().has_film()) spec.set_film(plan.film().film());
    if (dip_.immersion() > plan.immersions_size()) return;
    const v1::DipSetup& setup = plan.immersions(dip_.immersion() - 1);
    if (setup.has_pose()) *spec.mutable_pose() = setup.pose();
  }

  // The picture is only a help: without it, the step goes on.
  void show_picture() {
    const std::string name = dip_.picture().substr(dip_.picture().rfind('/') + 1);
    const auto files = download_all(program_.daemon(), progress_.plan_job(), {name}, out_);
    say(program_, "  " + (files ? files->front().path.string() : files.error().message) + "\n");
  }

  Program& program_;
  const v1::PlanProgress& progress_;
  const v1::PlanProgress::Dip& dip_;
  const StepOptions& options_;
  std::string out_;
};

}  // namespace

Status do_next_step(Program& program, const v1::PlanProgress& progress,
                    const StepOptions& options) {
  const int number = options.immersion == 0 ? progress.next_immersion() : options.immersion;
  if (number == 0) {
    if (program.json()) print(progress);
    return {};
  }
  for (const v1::PlanProgress::Dip& dip : progress.dips()) {
    if (dip.immersion() == number) return DipOfPlan(program, progress, dip, options).take_step();
  }
  return fail(Code::kInvalidArgument, fmt::format("--immersion {}: {} has {} dips", number,
                                                  progress.plan_job(), progress.dips_size()));
}

}  // namespace hydroprint::cli
