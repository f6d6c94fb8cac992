#pragma once

#include <string>

#include "sim/base/result.h"

namespace hydroprint::rest {

/// What goes back over HTTP when something was not done.
struct Answer {
  int http_status = 500;
  std::string json;  ///< {"error": {"code", "message", "status", "details"}} (AIP-193)
};

/// The HTTP status of a gRPC status code; 500 for one that does not exist.
[[nodiscard]] int http_status(int grpc_code);

/// A gRPC status as HTTP has it.
/// @param details  grpc::Status::error_details(): a google.rpc.Status, serialised. Each of its
/// details
///                 becomes an object with "@type", which is all there is of one of unknown type. A
///                 reason METHOD_NOT_ALLOWED makes it 405.
[[nodiscard]] Answer error_answer(int grpc_code, const std::string& message,
                                  const std::string& details);

/// An error that the HTTP side itself has, the same way.
[[nodiscard]] Answer error_answer(const Error& error);

}  // namespace hydroprint::rest
