#pragma once

#include <string>

#include "sim/base/result.h"

namespace hydroprint::rest {

/// Returns the number of a code, the same in google.rpc.Code and gRPC.
[[nodiscard]] int number_of(Code code);

/// Returns the details of an error beyond code and message: a serialised google.rpc.Status with
/// ErrorInfo{reason, domain "hydroprint", metadata}, BadRequest if fields of the request are wrong,
/// and RetryInfo if a retry may help. The errors of both gRPC and HTTP are converted here.
[[nodiscard]] std::string status_details(const Error& error);

}  // namespace hydroprint::rest
