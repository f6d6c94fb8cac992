#pragma once

#include <atomic>
#include <future>
#include <utility>

#include "sim/base/context.h"
#include "sim/base/result.h"

namespace hydroprint {

/// Runs `background` in its own thread while `foreground` runs in this one; runs them one after the
/// other if the context allows only one thread. If `foreground` fails, `background` is cancelled
/// and its result is dropped. Each function receives its own context; only the background reports
/// progress.
/// @return both values, or an error; the error of `foreground` takes precedence
template <class Background, class Foreground>
auto run_beside(const Context& context, const Background& background, const Foreground& foreground)
    -> Result<std::pair<typename decltype(background(context))::value_type,
                        typename decltype(foreground(context))::value_type>> {
  std::atomic<bool> is_dropped = false;
  Context behind = context;
  behind.cancelled = [&] { return is_dropped || context.is_cancelled(); };
  Context silent = context;
  silent.report = nullptr;
  const auto policy = context.threads > 1 ? std::launch::async : std::launch::deferred;
  auto later = std::async(policy, [&] { return background(behind); });
  auto now = foreground(silent);
  if (!now) {
    is_dropped = true;
    return tl::unexpected(std::move(now).error());
  }
  auto then = later.get();
  if (!then) return tl::unexpected(std::move(then).error());
  return std::pair(std::move(*then), std::move(*now));
}

}  // namespace hydroprint
