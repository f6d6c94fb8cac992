#pragma once

#include <string>

#include "sim/base/result.h"

namespace hydroprint::rest {

/// google.rpc.Code's number, which is gRPC's.
[[nodiscard]] int number_of(Code code);

/// What an error says beside code and message: a google.rpc.Status, serialised, with
/// ErrorInfo{reason, domain "hydroprint", metadata}, BadRequest where fields of the request are
/// wrong, and RetryInfo where trying again may help. The one place where errors become replies,
/// over gRPC and over HTTP.
[[nodiscard]] std::string status_details(const Error& error);

}  // namespace hydroprint::rest
