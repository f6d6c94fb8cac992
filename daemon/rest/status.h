#pragma once

#include <string>

#include "sim/base/result.h"

namespace hydroprint::rest {

/// The number of a code, the same in google.rpc.Code and gRPC.
[[nodiscard]] int number_of(Code code);

/// The details of an error beyond code and message: a serialised google.rpc.Status with
/// ErrorInfo{reason, domain "hydroprint", metadata}, BadRequest if fields of the request are wrong,
/// and RetryInfo if a retry may help. All errors become replies here, for both gRPC and HTTP.
[[nodiscard]] std::string status_details(const Error& error);

}  // namespace hydroprint::rest
