#include "daemon/http/credentials.h"

#include <algorithm>

#include "daemon/http/session_cookie.h"
#include "daemon/rpc/caller_metadata.h"

namespace hydroprint::http {
namespace {

// gRPC aborts the program if metadata contains other bytes.
bool is_printable(char c) { return c >= ' ' && c < 0x7f; }

bool is_printable(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return is_printable(c); });
}

}  // namespace

std::optional<std::string_view> cookie(const HeaderFields& fields, std::string_view name) {
  for (const HeaderField& field : fields.all()) {
    if (!same_name(field.name, "Cookie")) continue;
    for (const std::string_view pair : parts_of(field.value, ';')) {
      const std::size_t equals = pair.find('=');
      if (equals != std::string_view::npos && pair.substr(0, equals) == name) {
        return pair.substr(equals + 1);
      }
    }
  }
  return {};
}

Result<auth::Credentials> credentials_in(const Head& head, const std::string& peer,
                                         Unprintable unprintable) {
  const auto text_of = [&](const char* name,
                           std::optional<std::string_view> value) -> Result<std::string> {
    std::string text(value.value_or(""));
    if (unprintable == Unprintable::kRefuse && !is_printable(text)) {
      return fail_field(Code::kInvalidArgument, name, "must be printable ASCII",
                        ErrorReason::SPEC_INVALID);
    }
    std::replace_if(
        text.begin(), text.end(), [](char c) { return !is_printable(c); }, '?');
    return text;
  };
  auth::Credentials credentials;
  credentials.peer = peer;
  HP_ASSIGN_OR_RETURN(credentials.authorization,
                      text_of("authorization", head.fields.find("Authorization")));
  const auto owner = head.fields.find("Hydroprint-Owner");
  if (owner) {
    HP_ASSIGN_OR_RETURN(credentials.owner, text_of("hydroprint-owner", owner));
  }
  HP_ASSIGN_OR_RETURN(credentials.session,
                      text_of("hydroprint-session", cookie(head.fields, kSessionCookie)));
  return credentials;
}

Result<InProcessChannel::Metadata> admit(const ServerContext& server, Exchange& exchange,
                                         const std::string& method) {
  const Head& head = exchange.head();
  const bool is_stop = server.transcoder.stops_motion(head.method, head.target);
  HP_ASSIGN_OR_RETURN(const auth::Credentials credentials,
                      credentials_in(head, exchange.socket().peer(),
                                     is_stop ? Unprintable::kReplace : Unprintable::kRefuse));
  HP_ASSIGN_OR_RETURN(const auto caller, server.sources.admit(method, credentials));
  return daemon::caller_metadata(caller, credentials);
}

}  // namespace hydroprint::http
