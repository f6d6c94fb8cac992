#pragma once

#include <grpcpp/security/server_credentials.h>

#include <memory>

#include "daemon/tls/identity.h"

namespace hydroprint::daemon {

/// Has a gRPC server speak TLS, and show each client the identity that counts when it comes. Must
/// outlive the server.
[[nodiscard]] std::shared_ptr<grpc::ServerCredentials> tls_credentials(
    tls::CurrentIdentity identity);

}  // namespace hydroprint::daemon
