#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "tests/support/sphere_dips.h"

/// What the programs here have in common. Each takes some of the figures that tests/bench/run
/// prints, and writes them to stdout as one JSON object a line: {"row": NAME, FIGURE: VALUE, ...}.
namespace hydroprint::bench {

using Json = nlohmann::ordered_json;

void print(const std::string& row, Json figures);

/// Root mean square, largest, and how many points there are and are without film.
[[nodiscard]] Json json_of(const testing::Errors& errors);

/// Two threads.
[[nodiscard]] Context two_threads();

/// Ends the program.
[[noreturn]] void give_up(const Error& error);

/// The value; without one the program ends.
template <class T>
T value_of(Result<T> result) {
  if (!result) give_up(result.error());
  return std::move(*result);
}

}  // namespace hydroprint::bench
