#pragma once

#include <optional>
#include <string>

#include "daemon/http/protocol/request_parser.h"
#include "daemon/rest/security.h"
#include "sim/base/result.h"

namespace hydroprint::http {

using rest::kSessionCookie;

/// Returns kPermissionDenied, CSRF_TOKEN_MISSING if a request changes something, is authenticated
/// by the session cookie, and lacks the CSRF token of that session (from WhoAmI).
[[nodiscard]] Status check_csrf(const Head& head);

/// Returns the value of the header Set-Cookie after a call. It sets the session cookie after SignIn
/// and deletes it after SignOut; nullopt after other methods. Removes the session token from the
/// response of SignIn, so that scripts never see it.
/// @param is_secure  whether to restrict the cookie to TLS connections
[[nodiscard]] std::optional<std::string> take_session(const std::string& method,
                                                      std::string& response, bool is_secure);

}  // namespace hydroprint::http
