#include "daemon/dip/executor.h"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "daemon/dip/job_plan.h"
#include "daemon/platform/durable_file.h"
#include "daemon/platform/log.h"
#include "daemon/platform/resource_names.h"
#include "hardware/rig/limits.h"
#include "hydroprint/v1/job.pb.h"

namespace hydroprint::daemon {
namespace {

constexpr std::chrono::milliseconds kTick{20};
// Timeout for storing the end of a dip during shutdown.
constexpr std::chrono::seconds kShutdownPatience{5};

}  // namespace

DipExecutor::DipExecutor(const DipDependencies& dependencies)
    : dependencies_(dependencies), thread_([this] { loop(); }) {}

DipExecutor::~DipExecutor() { stop(); }

Result<DipExecutor::Order> DipExecutor::order_of(const JobRequest& request) const {
  const v1::DipSpec& spec = request.job.dip();
  HP_ASSIGN_OR_RETURN(const Lease lease, dependencies_.gateway.leases().require(request.lease_id));
  HP_ASSIGN_OR_RETURN(dip::Plan plan, plan_of(spec, dependencies_.jobs, dependencies_.layout));
  HP_RETURN_IF_ERROR(go_by_calibration(spec, dependencies_.jobs, dependencies_.calibrations,
                                       dependencies_.places.place(), plan));
  return Order{std::move(plan), lease.holder};
}

Status DipExecutor::check_rig(const dip::Plan& plan) const {
  HP_RETURN_IF_ERROR(dependencies_.gateway.check_at_rest());
  const rig::Controller& rig = *dependencies_.gateway.controller();
  HP_RETURN_IF_ERROR(dip::check(plan, rig.config()));
  if (!plan.clocks.skip) return {};
  if (!rig.profile().is_virtual) {
    return fail(
        Code::kFailedPrecondition,
        "yes_to_all: only possible with a virtual drive; leave it out and confirm each step",
        ErrorReason::STATE_FORBIDS);
  }
  const double here_mm = rig.snapshot().position_mm;
  HP_RETURN_IF_ERROR(dip::ways_from(plan, plan.contact_mm.value_or(here_mm), here_mm, rig.config(),
                                    rig.profile()));
  return {};
}

Result<Job> DipExecutor::check(const JobRequest& request) {
  HP_ASSIGN_OR_RETURN(const Order order, order_of(request));
  HP_RETURN_IF_ERROR(check_rig(order.plan));
  Job job;
  job.dip_status = first_dip_status(order.plan);
  job.state = JobState::kWaitingForOperator;
  job.definition = request.definition;
  return job;
}

Result<Job> DipExecutor::create(const JobRequest& request) {
  HP_ASSIGN_OR_RETURN(const Order order, order_of(request));
  const dip::Plan& plan = order.plan;
  const std::lock_guard lock(mutex_);
  if (end_)
    return fail(Code::kAborted, "the daemon is shutting down; try again after it has restarted",
                ErrorReason::SHUTTING_DOWN);
  HP_ASSIGN_OR_RETURN(auto earlier,
                      dependencies_.jobs.repeated(request.definition.owner, request.key));
  if (earlier) return std::move(*earlier);
  HP_RETURN_IF_ERROR(check_rig(plan));
  NewJob made = request.definition;
  made.dip_status = first_dip_status(plan);
  HP_ASSIGN_OR_RETURN(const Job job, dependencies_.jobs.create(made, request.key));
  if (const Status folder = make_folder(dependencies_.layout.dip(job.id)); !folder) {
    log(LogLevel::kError, "record_lost", {{"job", job.id}, {"message", folder.error().message}});
  }
  dependencies_.gateway.set_dip(job.id);
  dependencies_.gateway.claim(plan.clocks.skip);
  run_ = std::make_unique<DipSession>(dependencies_, job, plan, order.holder);
  wake();
  return job;
}

Result<Job> DipExecutor::confirm(std::int64_t id, dip::Step step, const std::string& holder) {
  const std::lock_guard lock(mutex_);
  HP_ASSIGN_OR_RETURN(const Job job, dependencies_.jobs.get(id));
  if (run_ && run_->job() == id) {
    HP_RETURN_IF_ERROR(run_->confirm(step, holder));
    wake();
    return dependencies_.jobs.get(id);
  }
  v1::DipStatus reached;
  reached.ParseFromString(job.dip_status);
  if (static_cast<int>(step) < reached.step()) return job;  // confirmed before
  return tl::unexpected(Error{Code::kFailedPrecondition,
                              fmt::format("{} is {}; it does not wait for a confirmation",
                                          job_name(id), name_of(job.state)),
                              ErrorReason::STATE_FORBIDS,
                              {{"state", name_of(job.state)}}});
}

Result<Job> DipExecutor::cancel(std::int64_t id) {
  // Stops the axis before any operation that may block.
  if (dependencies_.gateway.dip() == id) dependencies_.gateway.controller()->stop();
  const std::lock_guard lock(mutex_);
  if (run_ && run_->job() == id) run_->break_off(dip::Event::Kind::kCancel);
  auto job = dependencies_.jobs.cancel(id);
  wake();
  return job;
}

void DipExecutor::wake() {
  wake_ = true;
  woken_.notify_all();
}

void DipExecutor::loop() {
  std::unique_lock lock(mutex_);
  while (!end_ || (run_ && std::chrono::steady_clock::now() < end_by_)) {
    const auto news = [&] { return std::exchange(wake_, false) || (end_ && !run_); };
    if (run_) {
      woken_.wait_for(lock, kTick, news);
    } else {
      woken_.wait(lock, news);
    }
    if (!run_ || !run_->step()) continue;
    dependencies_.gateway.claim(false);
    dependencies_.gateway.set_dip(0);
    run_.reset();
  }
}

void DipExecutor::stop() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    end_ = true;
    end_by_ = std::chrono::steady_clock::now() + kShutdownPatience;
    if (run_) run_->break_off(dip::Event::Kind::kShutdown);
    wake();
  }
  thread_.join();
  if (rig::Controller* const rig = dependencies_.gateway.controller()) rig->stop();
}

}  // namespace hydroprint::daemon
