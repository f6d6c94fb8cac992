#include "daemon/dip_runner.h"

#include <chrono>
#include <utility>

#include "daemon/files.h"
#include "daemon/log.h"
#include "daemon/names.h"
#include "hardware/rig/limits.h"
#include "hydroprint/v1/job.pb.h"

namespace hydroprint::daemon {
namespace {

constexpr std::chrono::milliseconds kTick{20};
// A store that fails at the very end is not waited for.
constexpr std::chrono::seconds kShutdownPatience{5};

}  // namespace

DipRunner::DipRunner(const DipSurroundings& surroundings)
    : around_(surroundings), thread_([this] { loop(); }) {}

DipRunner::~DipRunner() { stop(); }

Status DipRunner::check(const dip::Plan& plan) const {
  HP_RETURN_IF_ERROR(around_.desk.check_at_rest());
  const rig::Controller& rig = *around_.desk.controller();
  HP_RETURN_IF_ERROR(dip::check(plan, rig.config()));
  if (!plan.clocks.skip) return {};
  if (!rig.profile().is_virtual) {
    return fail(Code::kFailedPrecondition,
                "yes_to_all: the drive is a real one; somebody has to look after this dip",
                "STATE_FORBIDS");
  }
  const double here_mm = rig.snapshot().position_mm;
  HP_RETURN_IF_ERROR(dip::ways_from(plan, plan.contact_mm.value_or(here_mm), here_mm, rig.config(),
                                    rig.profile()));
  return {};
}

Result<Job> DipRunner::create(NewJob made, const RequestKey& request, const dip::Plan& plan,
                              const std::string& holder) {
  const std::lock_guard lock(mutex_);
  if (end_) return fail(Code::kAborted, "the daemon is shutting down", "SHUTTING_DOWN");
  HP_ASSIGN_OR_RETURN(auto earlier, around_.jobs.repeated(made.owner, request));
  if (earlier) return std::move(*earlier);
  HP_RETURN_IF_ERROR(check(plan));
  made.dip_status = first_dip_status(plan);
  HP_ASSIGN_OR_RETURN(const Job job, around_.jobs.create(made, request));
  if (const Status folder = make_folder(around_.layout.dip(job.id)); !folder) {
    log(LogLevel::kError, "record_lost", {{"job", job.id}, {"message", folder.error().message}});
  }
  around_.desk.set_dip(job.id);
  around_.desk.claim(plan.clocks.skip);
  run_ = std::make_unique<DipRun>(around_, job, plan, holder);
  wake();
  return job;
}

Result<Job> DipRunner::confirm(std::int64_t id, dip::Step step, const std::string& holder) {
  const std::lock_guard lock(mutex_);
  HP_ASSIGN_OR_RETURN(const Job job, around_.jobs.get(id));
  if (run_ && run_->job() == id) {
    HP_RETURN_IF_ERROR(run_->confirm(step, holder));
    wake();
    return around_.jobs.get(id);
  }
  v1::DipStatus reached;
  reached.ParseFromString(job.dip_status);
  if (static_cast<int>(step) < reached.step()) return job;  // said again
  return tl::unexpected(
      Error{Code::kFailedPrecondition,
            job_name(id) + " is " + name_of(job.state) + "; it waits for nobody's confirmation",
            "STATE_FORBIDS",
            {{"state", name_of(job.state)}}});
}

Result<Job> DipRunner::cancel(std::int64_t id) {
  // Before anything that may have to wait.
  if (around_.desk.dip() == id) around_.desk.controller()->stop();
  const std::lock_guard lock(mutex_);
  if (run_ && run_->job() == id) run_->break_off(dip::Event::Kind::kCancel);
  auto job = around_.jobs.cancel(id);
  wake();
  return job;
}

void DipRunner::wake() {
  wake_ = true;
  woken_.notify_all();
}

void DipRunner::loop() {
  std::unique_lock lock(mutex_);
  while (!end_ || (run_ && std::chrono::steady_clock::now() < end_by_)) {
    const auto news = [&] { return std::exchange(wake_, false) || (end_ && !run_); };
    if (run_) {
      woken_.wait_for(lock, kTick, news);
    } else {
      woken_.wait(lock, news);
    }
    if (!run_ || !run_->step()) continue;
    around_.desk.claim(false);
    around_.desk.set_dip(0);
    run_.reset();
  }
}

void DipRunner::stop() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    end_ = true;
    end_by_ = std::chrono::steady_clock::now() + kShutdownPatience;
    if (run_) run_->break_off(dip::Event::Kind::kShutdown);
    wake();
  }
  thread_.join();
}

}  // namespace hydroprint::daemon
