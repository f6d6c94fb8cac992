#pragma once

#include <optional>
#include <string>

#include "daemon/http/protocol/request_parser.h"
#include "daemon/rest/security.h"
#include "sim/base/result.h"

namespace hydroprint::http {

using rest::kSessionCookie;

/// Returns kPermissionDenied, CSRF_TOKEN_MISSING for a change by a signed-in browser unless the
/// request carries the session's token (from WhoAmI).
[[nodiscard]] Status check_csrf(const Head& head);

/// Returns the Set-Cookie value after a call: the session after SignIn, its end after SignOut,
/// nullopt after other methods. Removes the session from SignIn's response, so that scripts never
/// see it.
/// @param is_secure  whether the browser may send the cookie over TLS only
[[nodiscard]] std::optional<std::string> take_session(const std::string& method,
                                                      std::string& response, bool is_secure);

}  // namespace hydroprint::http
