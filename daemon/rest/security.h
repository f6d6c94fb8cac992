#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace hydroprint::rest {

/// Name of the session cookie.
inline constexpr std::string_view kSessionCookie = "hydroprint_session";
/// Header that requests with a session must send when they change something.
inline constexpr std::string_view kCsrfHeader = "X-Hydroprint-Csrf";

/// Returns the authentication schemes for OpenAPI (components/securitySchemes).
[[nodiscard]] nlohmann::ordered_json security_schemes();

/// Returns the security requirement of an operation.
/// @param is_open  the operation needs no authentication
[[nodiscard]] nlohmann::ordered_json security_of(bool is_open, const std::string& http_method);

}  // namespace hydroprint::rest
