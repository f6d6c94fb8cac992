#include "daemon/workers/worker_executor.h"

#include "daemon/workers/local_executor.h"

namespace hydroprint::daemon {

std::optional<Observation> of_job(const Observations& seen, std::int64_t job) {
  const auto found = seen.find(job);
  return found == seen.end() ? std::nullopt : std::optional(found->second);
}

Adoption offer(WorkerExecutor& executor, const Execution& execution) {
  if (execution.executor == executor.name()) return executor.adopt(execution);
  return execution.executor == kLocalExecutor ? Adoption::kGone : Adoption::kNoAnswer;
}

Result<std::vector<Execution>> surviving(WorkerExecutor& executor, JobStore& store) {
  HP_ASSIGN_OR_RETURN(auto open, store.executions());
  std::erase_if(open, [&](const Execution& execution) {
    return offer(executor, execution) == Adoption::kGone;
  });
  return open;
}

}  // namespace hydroprint::daemon
