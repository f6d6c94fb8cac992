#pragma once

#include <grpcpp/security/server_credentials.h>

#include <memory>

#include "daemon/tls/identity.h"

namespace hydroprint::daemon {

/// Returns TLS credentials for a gRPC server that use the identity that is current when a client
/// connects.
/// The identity source must outlive the server.
[[nodiscard]] std::shared_ptr<grpc::ServerCredentials> tls_credentials(
    tls::CurrentIdentity identity);

}  // namespace hydroprint::daemon
