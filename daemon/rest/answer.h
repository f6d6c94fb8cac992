#pragma once

#include <string>

#include "sim/base/result.h"

namespace hydroprint::rest {

/// An error as an HTTP response.
struct Answer {
  int http_status = 500;
  std::string json;  ///< {"error": {"code", "message", "status", "details"}} (AIP-193)
};

/// Returns the HTTP status for a gRPC status code; 500 for an unknown code.
[[nodiscard]] int http_status(int grpc_code);

/// Converts a gRPC status to an HTTP response. Reason METHOD_NOT_ALLOWED results in status 405.
/// @param details  grpc::Status::error_details(): a serialised google.rpc.Status. Each detail
///                 becomes an object with "@type"; a detail of unknown type has no other field.
[[nodiscard]] Answer error_answer(int grpc_code, const std::string& message,
                                  const std::string& details);

/// Same as above, for an error of the HTTP server itself.
[[nodiscard]] Answer error_answer(const Error& error);

}  // namespace hydroprint::rest
