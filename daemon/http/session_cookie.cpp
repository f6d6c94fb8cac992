// Browser sessions: a cookie that scripts cannot read, and a CSRF token that pages must send in
// addition.
#include "daemon/http/session_cookie.h"

#include <fmt/format.h>

#include "daemon/auth/secret.h"
#include "daemon/http/credentials.h"
#include "hydroprint/v1/people_service.pb.h"

namespace hydroprint::http {
namespace {

constexpr std::string_view kSignIn = "/hydroprint.v1.PeopleService/SignIn";
constexpr std::string_view kSignOut = "/hydroprint.v1.PeopleService/SignOut";
using rest::kCsrfHeader;

std::string cookie_text(std::string_view token, bool is_secure, std::string_view more) {
  return fmt::format("{}={}; Path=/; HttpOnly; SameSite=Strict{}{}", kSessionCookie, token,
                     is_secure ? "; Secure" : "", more);
}

}  // namespace

Status check_csrf(const Head& head) {
  if (head.method == "GET" || head.method == "HEAD" || head.method == "OPTIONS") return {};
  const auto session = cookie(head.fields, kSessionCookie);
  // A foreign page cannot add an API key to a forged request.
  if (!session || head.fields.find("Authorization")) return {};
  const std::string wanted = auth::csrf_token(*session);
  if (auth::equal_in_constant_time(head.fields.find(kCsrfHeader).value_or(""), wanted)) return {};
  return fail(Code::kPermissionDenied,
              fmt::format("requests that make changes with a session require the header {}; reload "
                          "the page, or use the value that /v1/session returns",
                          kCsrfHeader),
              ErrorReason::CSRF_TOKEN_MISSING);
}

std::optional<std::string> take_session(const std::string& method, std::string& response,
                                        bool is_secure) {
  if (method == kSignOut) return cookie_text("", is_secure, "; Max-Age=0");
  v1::SignInResponse signed_in;
  if (method != kSignIn || !signed_in.ParseFromString(response)) return {};
  const std::string set = cookie_text(signed_in.session_token(), is_secure, "");
  signed_in.clear_session_token();
  response = signed_in.SerializeAsString();
  return set;
}

}  // namespace hydroprint::http
