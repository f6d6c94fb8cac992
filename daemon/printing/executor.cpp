#include "daemon/printing/executor.h"

#include <utility>

namespace hydroprint::daemon {

PrintExecutor::PrintExecutor(std::optional<PrinterConfig> setup, JobStore& jobs,
                             DeviceJobs& device_jobs, const Layout& layout)
    : setup_(std::move(setup)), jobs_(jobs), device_jobs_(device_jobs), layout_(layout) {}

PrintExecutor::~PrintExecutor() { stop(); }

Status PrintExecutor::check_printer() const {
  if (setup_) return {};
  return fail(Code::kFailedPrecondition,
              "no printer is configured; set printer.address in the daemon's configuration, or "
              "download print.pdf and print it elsewhere",
              ErrorReason::PRINTER_MISSING);
}

Result<Job> PrintExecutor::check(const JobRequest& request) {
  HP_RETURN_IF_ERROR(print_plan_of(request.job.print(), jobs_, layout_));
  HP_RETURN_IF_ERROR(check_printer());
  Job job;
  job.definition = request.definition;
  return job;
}

Result<Job> PrintExecutor::create(const JobRequest& request) {
  HP_ASSIGN_OR_RETURN(const PrintPlan plan, print_plan_of(request.job.print(), jobs_, layout_));
  const std::lock_guard lock(mutex_);
  if (end_)
    return fail(Code::kAborted, "the daemon is shutting down; try again after it has restarted",
                ErrorReason::SHUTTING_DOWN);
  HP_RETURN_IF_ERROR(check_printer());
  HP_ASSIGN_OR_RETURN(auto earlier, jobs_.repeated(request.definition.owner, request.key));
  if (earlier) return std::move(*earlier);
  HP_ASSIGN_OR_RETURN(Job job, jobs_.create(request.definition, request.key));
  // The thread of the last print is about to end, because the store allows only one print at a
  // time.
  if (thread_.joinable()) thread_.join();
  run_ = std::make_unique<PrintSession>(*setup_, device_jobs_, layout_, job, plan);
  thread_ = std::thread([run = run_.get()] { run->go(); });
  return job;
}

Result<Job> PrintExecutor::cancel(std::int64_t id) {
  const std::lock_guard lock(mutex_);
  auto job = jobs_.cancel(id);
  if (job && run_ && run_->job() == id) run_->cancel();
  return job;
}

void PrintExecutor::stop() {
  {
    const std::lock_guard lock(mutex_);
    end_ = true;
    if (run_) run_->leave();
  }
  if (thread_.joinable()) thread_.join();
}

}  // namespace hydroprint::daemon
