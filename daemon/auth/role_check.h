#pragma once

#include <grpcpp/impl/service_type.h>

#include <memory>
#include <optional>
#include <set>
#include <string>

#include "daemon/auth/authenticator.h"

namespace google::protobuf {
class MethodDescriptor;
}

namespace hydroprint::daemon {

/// The least role that may call a method; none: whoever reaches the daemon.
using Need = std::optional<auth::Role>;

/// What a method states (access.proto).
/// @return kInternal if it states nothing, or both
[[nodiscard]] Result<Need> need_of(const google::protobuf::MethodDescriptor& method);

/// The same service behind a gate: each of its methods answers whoever may not call it before it
/// looks at the request. This is the one place where roles are checked, and no method gets past it
/// but those of `check_themselves`, which are answered by threads of their own (gRPC's callback
/// API) and have to call Authenticator::admit.
/// @param name  "hydroprint.v1.JobService"
/// @return kInternal for a service with a method that states no role
[[nodiscard]] Result<std::unique_ptr<grpc::Service>> guarded(
    const std::string& name, std::unique_ptr<grpc::Service> inner, const Authenticator& access,
    const std::set<std::string>& check_themselves);

}  // namespace hydroprint::daemon
