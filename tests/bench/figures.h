#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "sim/base/result.h"
#include "tests/support/sphere_dips.h"
#include "tests/support/two_threads.h"

/// Common code of the benchmark programs. Each program measures some of the rows of tests/bench/run
/// and writes one JSON object per line to stdout: {"row": NAME, FIGURE: VALUE, ...}.
namespace hydroprint::bench {

using Json = nlohmann::ordered_json;
using testing::two_threads;

void print(const std::string& row, Json figures);

/// The errors as figures of a row: root mean square, maximum, number of points, and number of
/// points without film.
[[nodiscard]] Json json_of(const testing::Errors& errors);

/// Prints the error and exits with status 1.
[[noreturn]] void give_up(const Error& error);

/// Returns the value, or ends the program if there is an error.
template <class T>
T value_of(Result<T> result) {
  if (!result) give_up(result.error());
  return std::move(*result);
}

}  // namespace hydroprint::bench
