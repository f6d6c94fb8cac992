#pragma once

#include <grpcpp/support/server_interceptor.h>

#include <memory>

#include "daemon/auth/audit_log.h"
#include "daemon/auth/role_check.h"

namespace hydroprint::daemon {

/// Records calls that change something (all except google.api.http GET): the caller, the resource
/// and the result. Skips unauthenticated calls, SignIn (which PeopleService records), streams (such
/// as UploadChunk) and previews. Frequent calls (Jog, RenewLease) are recorded at most once a
/// minute. The response waits until the entry is on disk, at most two seconds. Calls that stop the
/// rig or keep it in motion (StopMotion, Jog, RenewLease) never wait.
[[nodiscard]] std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface>
make_audit_interceptor(auth::AuditLog& audit);

/// Returns a function that records calls that an endpoint rejects because of the caller's role. It
/// skips the same calls as make_audit_interceptor(), and does not wait; `audit` must outlive it.
[[nodiscard]] OnRefusal make_refusal_recorder(auth::AuditLog& audit);

}  // namespace hydroprint::daemon
