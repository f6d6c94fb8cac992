#pragma once

#include <vector>

#include "proto/rules/check.h"
#include "sim/base/result.h"

namespace hydroprint::rest {

/// Builds the error of a request with wrong fields. It carries all violations (at most 16), which
/// replies show as google.rpc.BadRequest. Reason and metadata `field` are those of the first
/// violation.
/// @param violations  at least one
[[nodiscard]] Error bad_request(const std::vector<rules::Violation>& violations);

/// The wrong fields that an error carries: those passed to bad_request(), or the one that its
/// metadata `field` names.
[[nodiscard]] std::vector<rules::Violation> violations_of(const Error& error);

/// The metadata of an error as replies show it: without the entries that bad_request() added.
[[nodiscard]] std::map<std::string, std::string> shown_metadata(const Error& error);

}  // namespace hydroprint::rest
