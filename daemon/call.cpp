#include "daemon/call.h"

#include "daemon/names.h"

namespace hydroprint::daemon {

Result<std::string> owner_of(const grpc::ServerContextBase& context) {
  const auto& metadata = context.client_metadata();
  const auto found = metadata.find("hydroprint-owner");
  if (found == metadata.end()) return std::string("anonymous");
  const std::string owner(found->second.data(), found->second.size());
  const bool printable =
      std::all_of(owner.begin(), owner.end(), [](char c) { return c > ' ' && c < 0x7f; });
  if (owner.empty() || owner.size() > 64 || !printable) {
    return invalid_field("hydroprint-owner",
                         "must be 1 to 64 printable ASCII characters without blanks");
  }
  return owner;
}

Result<int> page_size(std::int32_t asked, int otherwise) {
  if (asked < 0) return invalid_field("page_size", "must not be negative");
  return asked == 0 ? otherwise : std::min(asked, 1000);
}

Status check_serving(const Backend& backend) {
  if (!backend.stopping) return {};
  return fail(Code::kUnavailable, "the daemon is shutting down; try again when it is back",
              "SHUTTING_DOWN");
}

Error never_again(Error error) {
  if (error.code == Code::kUnavailable || error.reason == "DRIVE_BUSY") error.code = Code::kAborted;
  return error;
}

tl::unexpected<Error> bad_page_token() {
  return fail(Code::kInvalidArgument, "page_token: no page gave this one; begin again without it",
              "PAGE_TOKEN_INVALID");
}

Result<std::int64_t> number_token(const std::string& token) {
  if (token.empty()) return 0;
  const std::int64_t number = parse_number(token);
  if (number == 0) return bad_page_token();
  return number;
}

}  // namespace hydroprint::daemon
