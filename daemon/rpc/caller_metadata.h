#pragma once

#include <grpcpp/server_context.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/auth/account.h"
#include "sim/base/result.h"

namespace hydroprint::daemon {

// Metadata with which the endpoints pass the caller to the services, which are called only within
// the process.

/// Metadata of a gRPC call: names in lower case, values in printable ASCII.
using CallMetadata = std::vector<std::pair<std::string, std::string>>;

/// Returns the metadata of an authorized call.
/// @param caller  nullopt if the method needs no sign-in and the caller is unknown
[[nodiscard]] CallMetadata caller_metadata(const std::optional<auth::Caller>& caller,
                                           const auth::Credentials& credentials);

/// Returns the caller that the endpoint determined.
/// @return kUnauthenticated, SIGN_IN_NEEDED if the metadata contains no caller
[[nodiscard]] Result<auth::Caller> caller_of(const grpc::ServerContextBase& context);

/// Returns the credentials of the call.
[[nodiscard]] auth::Credentials credentials_of(const grpc::ServerContextBase& context);

/// Returns the value of a metadata key; empty if the call does not have it.
[[nodiscard]] std::string metadata_value(const grpc::ServerContextBase& context, const char* name);

}  // namespace hydroprint::daemon
