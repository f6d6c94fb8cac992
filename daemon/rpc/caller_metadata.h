#pragma once

#include <grpcpp/server_context.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/auth/account.h"
#include "sim/base/result.h"

namespace hydroprint::daemon {

// How the endpoints tell the services, which are called within the process only, who calls.

/// Metadata of a gRPC call: names in lower case, values in printable ASCII.
using CallMetadata = std::vector<std::pair<std::string, std::string>>;

/// The metadata of an admitted call.
/// @param caller  nullopt: not known; the method needs no sign-in
[[nodiscard]] CallMetadata caller_metadata(const std::optional<auth::Caller>& caller,
                                           const auth::Credentials& credentials);

/// The caller that the endpoint established.
/// @return kUnauthenticated, SIGN_IN_NEEDED if the caller is not known
[[nodiscard]] Result<auth::Caller> caller_of(const grpc::ServerContextBase& context);

/// The credentials that came with the call.
[[nodiscard]] auth::Credentials credentials_of(const grpc::ServerContextBase& context);

/// The value of a call's metadata; empty if it has none of that name.
[[nodiscard]] std::string metadata_value(const grpc::ServerContextBase& context, const char* name);

}  // namespace hydroprint::daemon
