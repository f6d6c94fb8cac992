#pragma once

#include <grpcpp/security/server_credentials.h>

#include <memory>

#include "daemon/tls/identity.h"

namespace hydroprint::daemon {

/// Makes a gRPC server use TLS, with the identity that is current when a client connects. The
/// object must outlive the server.
[[nodiscard]] std::shared_ptr<grpc::ServerCredentials> tls_credentials(
    tls::CurrentIdentity identity);

}  // namespace hydroprint::daemon
