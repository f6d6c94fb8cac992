#pragma once

#include <grpcpp/support/status.h>

#include "daemon/rest/status.h"
#include "sim/base/result.h"

namespace hydroprint::daemon {

using rest::number_of;

/// Converts an error to a gRPC status with code, message and rest::status_details().
[[nodiscard]] grpc::Status to_grpc(const Error& error);
[[nodiscard]] grpc::Status to_grpc(const Status& status);

}  // namespace hydroprint::daemon
