#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "sim/base/result.h"

namespace hydroprint::worker {

/// Returns an error in the form of hydroprint.v1.Failure, with the field names of the .proto file.
[[nodiscard]] nlohmann::ordered_json failure_json(const Error& error);

/// Prints {"error": Failure} on stdout, for programs.
void print_failure(const Error& error, ExitStatus status);

/// Prints "PROGRAM: WORDS" on stderr, for people.
void print_error(std::string_view program, std::string_view words);

}  // namespace hydroprint::worker
