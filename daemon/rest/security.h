#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace hydroprint::rest {

/// Name of the session cookie.
inline constexpr std::string_view kSessionCookie = "hydroprint_session";
/// Name of the header with the CSRF token, required in requests that make changes with a session.
inline constexpr std::string_view kCsrfHeader = "X-Hydroprint-Csrf";

/// Returns the authentication schemes for OpenAPI (components/securitySchemes).
[[nodiscard]] nlohmann::ordered_json security_schemes();

/// Returns the security requirement of an operation.
/// @param is_open  whether the operation can be called without authentication
[[nodiscard]] nlohmann::ordered_json security_of(bool is_open, const std::string& http_method);

}  // namespace hydroprint::rest
