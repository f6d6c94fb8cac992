#pragma once

#include <vector>

#include "proto/rules/check.h"
#include "sim/base/result.h"

namespace hydroprint::rest {

/// Creates the error for a request with wrong fields. It carries all violations (at most 16), which
/// responses contain as google.rpc.BadRequest. Reason and field are those of the first
/// violation.
/// @param violations  at least one
[[nodiscard]] Error bad_request(const std::vector<rules::Violation>& violations);

/// Returns the wrong fields of an error: those passed to bad_request(), or the one in its metadata
/// `field`.
[[nodiscard]] std::vector<rules::Violation> violations_of(const Error& error);

/// Returns the metadata of an error for responses: without the entries that bad_request() added.
[[nodiscard]] std::map<std::string, std::string> shown_metadata(const Error& error);

}  // namespace hydroprint::rest
