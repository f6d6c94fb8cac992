#pragma once

#include <cstddef>
#include <functional>
#include <string_view>

#include "sim/base/result.h"

namespace hydroprint {

/// What long work is given: how many threads it may use, whom to tell how far it is, and whom to
/// ask whether to go on. The work itself knows no clock; whoever listens may have one.
struct Context {
  int threads = 1;
  /// Called with the stage's name ("reading", "waterline", "velocity", "flow map", ...) and the
  /// share of that stage done, in [0, 1]. May be called from any thread, one call at a time.
  std::function<void(std::string_view stage, double fraction)> report;
  /// Asked often, from any thread; true ends the work with Code::kCancelled.
  std::function<bool()> cancelled;

  [[nodiscard]] bool is_cancelled() const { return cancelled && cancelled(); }
  void progress(std::string_view stage, double fraction) const {
    if (report) report(stage, fraction);
  }
};

/// kCancelled if the context says so.
[[nodiscard]] Status check_cancelled(const Context& context);

/// Runs work(0) ... work(count - 1) on context.threads threads, in any order, reporting progress of
/// `stage` (empty: none) and stopping early on cancel. Each index must write only its own results,
/// so that the outcome does not depend on the number of threads.
/// @return kCancelled, or the error of the smallest index seen to fail.
[[nodiscard]] Status parallel_for(const Context& context, std::string_view stage, std::size_t count,
                                  const std::function<Status(std::size_t)>& work);

}  // namespace hydroprint
