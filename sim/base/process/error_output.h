#pragma once

#include <string_view>

#include "sim/base/result.h"

namespace hydroprint::worker {

/// Reports a failure of `program`: one line on stderr and, if `json`, also
/// {"error":{"code","reason","message","metadata","exit_status"}} on stdout.
void print_error(const Error& error, ExitStatus status, bool json,
                 std::string_view program = "hydroprint-worker");

}  // namespace hydroprint::worker
