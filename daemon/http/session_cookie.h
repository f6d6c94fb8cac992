#pragma once

#include <optional>
#include <string>

#include "daemon/http/protocol/request_parser.h"
#include "daemon/rest/security.h"
#include "sim/base/result.h"

namespace hydroprint::http {

using rest::kSessionCookie;

/// Refuses (kPermissionDenied, CSRF_TOKEN_MISSING) a change by a browser that is signed in, unless
/// the request carries the session's token (WhoAmI returns it).
[[nodiscard]] Status check_csrf(const Head& head);

/// The Set-Cookie value after a call: the session after SignIn, its end after SignOut, nullopt
/// after other methods. Takes the session out of SignIn's response, so that scripts never see it.
/// @param is_secure  whether the browser must send the cookie over TLS only
[[nodiscard]] std::optional<std::string> take_session(const std::string& method,
                                                      std::string& response, bool is_secure);

}  // namespace hydroprint::http
