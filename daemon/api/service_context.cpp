#include "daemon/api/service_context.h"

#include "daemon/platform/resource_names.h"
#include "daemon/rpc/caller_metadata.h"

namespace hydroprint::daemon {

Result<std::string> owner_of(const grpc::ServerContextBase& context) {
  HP_ASSIGN_OR_RETURN(auth::Caller caller, caller_of(context));
  return std::move(caller).name;
}

Result<int> page_size(std::int32_t size, int default_size) {
  if (size < 0) return invalid_field("page_size", "must not be negative");
  return size == 0 ? default_size : std::min(size, 1000);
}

Status check_serving(const ServiceContext& backend) {
  if (!backend.stopping) return {};
  return fail(Code::kUnavailable, "the daemon is shutting down; try again after it has restarted",
              ErrorReason::SHUTTING_DOWN);
}

Error never_again(Error error) {
  if (error.code == Code::kUnavailable || error.reason == ErrorReason::DRIVE_BUSY)
    error.code = Code::kAborted;
  return error;
}

tl::unexpected<Error> bad_page_token() {
  return fail(Code::kInvalidArgument, "page_token: not valid; repeat the request without it",
              ErrorReason::PAGE_TOKEN_INVALID);
}

Result<std::int64_t> number_token(const std::string& token) {
  if (token.empty()) return 0;
  const std::int64_t number = parse_number(token);
  if (number == 0) return bad_page_token();
  return number;
}

}  // namespace hydroprint::daemon
