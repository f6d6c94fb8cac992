#pragma once

#include <stdexcept>
#include <utility>

#include "sim/base/result.h"

namespace hydroprint::testing {

/// Returns the value, or throws the error's message.
template <class T>
T value_of(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(*result);
}

}  // namespace hydroprint::testing
