#include "sim/base/context.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <optional>

namespace hydroprint {

Status check_cancelled(const Context& context) {
  if (context.is_cancelled()) return fail(Code::kCancelled, "cancelled");
  return {};
}

Status parallel_for(const Context& context, std::string_view stage, std::size_t count,
                    const std::function<Status(std::size_t)>& work) {
  std::size_t done = 0;
  std::atomic<bool> stop = false;
  std::mutex mutex;
  std::size_t failed_at = count;
  std::optional<Error> error;

  const auto one = [&](std::size_t i) {
    if (stop || context.is_cancelled()) return;
    Status status = work(i);
    const std::lock_guard lock(mutex);
    ++done;
    if (!status && i < failed_at) {
      failed_at = i;
      error = std::move(status).error();
      stop = true;
    }
    if (!stage.empty()) {
      context.progress(stage, static_cast<double>(done) / static_cast<double>(count));
    }
  };
  tbb::task_arena arena(std::max(1, context.threads));
  arena.execute([&] { tbb::parallel_for(std::size_t{0}, count, one, tbb::simple_partitioner()); });
  if (context.is_cancelled()) return fail(Code::kCancelled, "cancelled");
  if (error) return tl::unexpected(std::move(*error));
  return {};
}

}  // namespace hydroprint
