#pragma once

#include <grpcpp/support/status.h>

#include "sim/base/result.h"

namespace hydroprint::daemon {

/// google.rpc.Code's number.
[[nodiscard]] int number_of(Code code);

/// The one place where errors become replies: code and message, and as details a google.rpc.Status
/// with ErrorInfo{reason, domain "hydroprint", metadata}; RetryInfo where trying again may help.
[[nodiscard]] grpc::Status to_grpc(const Error& error);
[[nodiscard]] grpc::Status to_grpc(const Status& status);

}  // namespace hydroprint::daemon
