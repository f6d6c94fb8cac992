#pragma once

#include <cstddef>
#include <functional>
#include <string_view>

#include "sim/base/result.h"

namespace hydroprint {

/// The environment of long-running work: its number of threads, a progress callback and a
/// cancellation check. The work itself reads no clock; the callbacks may.
struct Context {
  int threads = 1;
  /// Called with the stage's name ("reading", "waterline", "velocity", "flow map", ...) and the
  /// share of that stage done, in [0, 1]. May be called from any thread, one call at a time.
  std::function<void(std::string_view stage, double fraction)> report;
  /// Called often, from any thread; returns true to end the work with Code::kCancelled.
  std::function<bool()> cancelled;

  [[nodiscard]] bool is_cancelled() const { return cancelled && cancelled(); }
  void progress(std::string_view stage, double fraction) const {
    if (report) report(stage, fraction);
  }
};

/// Returns kCancelled if the context is cancelled.
[[nodiscard]] Status check_cancelled(const Context& context);

/// Runs work(0) ... work(count - 1) on context.threads threads, in any order. Reports progress of
/// `stage` (empty: no reports) and stops early on cancellation. Each index must write only its own
/// results, so that the outcome does not depend on the number of threads.
/// @return kCancelled, or the error with the smallest index among those that occurred
[[nodiscard]] Status parallel_for(const Context& context, std::string_view stage, std::size_t count,
                                  const std::function<Status(std::size_t)>& work);

}  // namespace hydroprint
