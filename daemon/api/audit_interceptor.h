#pragma once

#include <grpcpp/support/server_interceptor.h>

#include <memory>
#include <string_view>

#include "daemon/auth/account.h"
#include "daemon/auth/audit_log.h"

namespace hydroprint::daemon {

/// Records calls that change something (all except google.api.http GET): the caller, the object and
/// the result. Leaves out unauthenticated calls, SignIn (which records itself), uploaded chunks and
/// previews. Frequent calls (Jog, RenewLease) are recorded at most once a minute.
///
/// A call is answered once its entry is on disk, or after two seconds. Calls that stop the rig or
/// keep it in motion (StopMotion, Jog, RenewLease) never wait.
[[nodiscard]] std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface>
make_audit_interceptor(auth::AuditLog& audit);

/// Records that an endpoint refused a call, if calls of the method are recorded. Does not wait.
void record_refusal(auth::AuditLog& audit, const auth::Caller& caller, std::string_view method,
                    const Error& error);

}  // namespace hydroprint::daemon
