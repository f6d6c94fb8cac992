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

/// The role required to call a method; nullopt: no sign-in is needed.
using Need = std::optional<auth::Role>;

/// Reads the requirement of a method (access.proto).
/// @return kInternal if the method states none, or both options
[[nodiscard]] Result<Need> need_of(const google::protobuf::MethodDescriptor& method);

/// Wraps a service so that each method refuses unauthorized callers before it reads the request.
/// Roles are checked only here. Methods in `check_themselves` are exempt: they use gRPC's callback
/// API with their own threads, and must call Authenticator::admit.
/// @param name  "hydroprint.v1.JobService"
/// @return kInternal for a service with a method that states no role
[[nodiscard]] Result<std::unique_ptr<grpc::Service>> guarded(
    const std::string& name, std::unique_ptr<grpc::Service> inner, const Authenticator& access,
    const std::set<std::string>& check_themselves);

}  // namespace hydroprint::daemon
