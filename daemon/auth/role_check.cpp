#include "daemon/auth/role_check.h"

#include <google/protobuf/descriptor.h>

#include "hydroprint/v1/access.pb.h"

namespace hydroprint::daemon {

using google::protobuf::MethodDescriptor;
using google::protobuf::ServiceDescriptor;

Result<Need> need_of(const MethodDescriptor& method) {
  const bool is_open = method.options().GetExtension(v1::without_sign_in);
  const v1::Role role = method.options().GetExtension(v1::role);
  const bool has_role = v1::Role_IsValid(role) && role != v1::ROLE_UNSPECIFIED;
  if (is_open != has_role) {
    return is_open ? Need() : Need(static_cast<auth::Role>(role));
  }
  return fail(Code::kInternal, method.full_name() +
                                   ": must declare exactly one access rule: the option "
                                   "role or without_sign_in (hydroprint/v1/access.proto)");
}

Result<RoleCheck> RoleCheck::make(const Authenticator& authenticator,
                                  const std::vector<std::string>& services, OnRefusal on_refusal) {
  RoleCheck check(authenticator, std::move(on_refusal));
  for (const std::string& name : services) {
    const ServiceDescriptor* const service =
        google::protobuf::DescriptorPool::generated_pool()->FindServiceByName(name);
    if (service == nullptr) return fail(Code::kInternal, name + ": unknown service");
    for (int i = 0; i < service->method_count(); ++i) {
      const MethodDescriptor& method = *service->method(i);
      HP_ASSIGN_OR_RETURN(const Need need, need_of(method));
      check.rules_["/" + name + "/" + method.name()] = {
          need, method.options().GetExtension(v1::stops_motion)};
    }
  }
  return check;
}

Result<std::optional<auth::Caller>> RoleCheck::admit(std::string_view method,
                                                     const auth::Credentials& credentials) const {
  const auto found = rules_.find(method);
  if (found == rules_.end()) {
    return fail(Code::kUnimplemented,
                "the daemon does not have this method; check its name, or update the daemon",
                ErrorReason::ROUTE_NOT_FOUND);
  }
  const auto& [need, stops_motion] = found->second;
  auto caller = authenticator_->caller(credentials);
  if (stops_motion && !caller && caller.error().code == Code::kInvalidArgument) {
    auth::Credentials nameless = credentials;
    nameless.owner.reset();
    caller = authenticator_->caller(nameless);
  }
  if (!need) return caller ? std::optional(*std::move(caller)) : std::nullopt;
  if (!caller) return tl::unexpected(caller.error());
  if (const Status allowed = check_role(*caller, *need); !allowed) {
    if (on_refusal_) on_refusal_(*caller, method, allowed.error());
    return tl::unexpected(allowed.error());
  }
  return std::optional(*std::move(caller));
}

}  // namespace hydroprint::daemon
