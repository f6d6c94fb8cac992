// The part of a daemon that runs workers, at a DetachedExecutor. SIGTERM ends it as it ends the
// daemon.
//
// usage: detached_daemon STATE_FOLDER WORKER CAPACITY

#include <signal.h>

#include <iostream>
#include <string>

#include "daemon/workers/worker_pool.h"
#include "tests/daemon/workers/adoption/detached_executor.h"
#include "tests/daemon/workers/adoption/pool_store.h"

namespace hydroprint::daemon {
namespace {

Status run(const std::filesystem::path& state, const std::string& worker, int capacity,
           const sigset_t& end) {
  PoolStore store(state);
  DetachedExecutor executor(state, capacity);
  HP_ASSIGN_OR_RETURN(const auto kept, surviving(executor, store.jobs));
  HP_RETURN_IF_ERROR(store.retention.sweep(kept));
  HP_RETURN_IF_ERROR(store.jobs.interrupt_all(Interruption::kLoss, kept));
  PoolOptions options;
  options.program = worker;
  HP_ASSIGN_OR_RETURN(auto pool, WorkerPool::make(options, executor, store.jobs, store.queue,
                                                  store.layout, system_clock_ms));
  pool->start();
  int signal = 0;
  ::sigwait(&end, &signal);
  pool->stop();
  HP_ASSIGN_OR_RETURN(const auto left, surviving(executor, store.jobs));
  return store.jobs.interrupt_all(Interruption::kShutdown, left);
}

}  // namespace
}  // namespace hydroprint::daemon

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  sigset_t end;
  sigemptyset(&end);
  sigaddset(&end, SIGTERM);
  sigprocmask(SIG_BLOCK, &end, nullptr);  // the pool's thread inherits it
  const auto done = hydroprint::daemon::run(argv[1], argv[2], std::stoi(argv[3]), end);
  if (!done) std::cerr << done.error().message << '\n';
  return done ? 0 : 1;
}
