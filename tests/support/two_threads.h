#pragma once

#include "sim/base/context.h"

namespace hydroprint::testing {

/// A context with two threads.
[[nodiscard]] inline Context two_threads() {
  Context context;
  context.threads = 2;
  return context;
}

}  // namespace hydroprint::testing
