#pragma once

#include <string>

#include "sim/base/result.h"

namespace hydroprint::rest {

/// An error as HTTP sends it.
struct Answer {
  int http_status = 500;
  std::string json;  ///< {"error": {"code", "message", "status", "details"}} (AIP-193)
};

/// The HTTP status of a gRPC status code; 500 for one that does not exist.
[[nodiscard]] int http_status(int grpc_code);

/// Converts a gRPC status to an HTTP answer.
/// @param details  grpc::Status::error_details(): a serialised google.rpc.Status. Each detail
/// becomes an object with "@type"; a detail of an unknown type has no other field. Reason
/// METHOD_NOT_ALLOWED makes the status 405.
[[nodiscard]] Answer error_answer(int grpc_code, const std::string& message,
                                  const std::string& details);

/// Same, for an error of the HTTP side itself.
[[nodiscard]] Answer error_answer(const Error& error);

}  // namespace hydroprint::rest
