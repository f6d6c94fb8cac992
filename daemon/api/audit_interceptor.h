#pragma once

#include <grpcpp/support/server_interceptor.h>

#include <memory>

#include "daemon/auth/audit_log.h"

namespace hydroprint::daemon {

/// Sees the calls that change something (by their google.api.http: all but those that get) and
/// notes who made them, on what, and how they ended. Left out: calls of nobody known, SignIn, which
/// notes itself, uploaded chunks, previews, and of what is said again and again (Jog, RenewLease)
/// all but once a minute. A call is answered once its entry is on disk, or after two seconds; those
/// that stop the rig or hold it in motion (StopMotion, Jog, RenewLease) never wait for that.
[[nodiscard]] std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface>
make_audit_interceptor(auth::AuditLog& audit);

}  // namespace hydroprint::daemon
