#include "daemon/print_runner.h"

#include <utility>

namespace hydroprint::daemon {

PrintRunner::PrintRunner(std::optional<PrinterSetup> setup, JobStore& jobs, const Layout& layout)
    : setup_(std::move(setup)), jobs_(jobs), layout_(layout) {}

PrintRunner::~PrintRunner() { stop(); }

Status PrintRunner::check() const {
  if (setup_) return {};
  return fail(Code::kFailedPrecondition,
              "no printer is configured; set printer.address in the daemon's configuration, or "
              "download print.pdf and print it elsewhere",
              "PRINTER_MISSING");
}

Result<Job> PrintRunner::create(const NewJob& made, const RequestKey& request,
                                const PrintPlan& plan) {
  const std::lock_guard lock(mutex_);
  if (end_) return fail(Code::kAborted, "the daemon is shutting down", "SHUTTING_DOWN");
  HP_RETURN_IF_ERROR(check());
  HP_ASSIGN_OR_RETURN(auto earlier, jobs_.repeated(made.owner, request));
  if (earlier) return std::move(*earlier);
  HP_ASSIGN_OR_RETURN(Job job, jobs_.create(made, request));
  // The store has it that no other one is under way.
  if (thread_.joinable()) thread_.join();
  run_ = std::make_unique<PrintRun>(*setup_, jobs_, layout_, job, plan);
  thread_ = std::thread([run = run_.get()] { run->go(); });
  return job;
}

Result<Job> PrintRunner::cancel(std::int64_t id) {
  const std::lock_guard lock(mutex_);
  auto job = jobs_.cancel(id);
  if (job && run_ && run_->job() == id) run_->cancel();
  return job;
}

std::int64_t PrintRunner::job() const {
  const std::lock_guard lock(mutex_);
  return run_ && !run_->is_over() ? run_->job() : 0;
}

void PrintRunner::stop() {
  {
    const std::lock_guard lock(mutex_);
    end_ = true;
    if (run_) run_->leave();
  }
  if (thread_.joinable()) thread_.join();
}

}  // namespace hydroprint::daemon
