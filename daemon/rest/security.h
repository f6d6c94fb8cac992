#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace hydroprint::rest {

/// The cookie that a session is kept in.
inline constexpr std::string_view kSessionCookie = "hydroprint_session";
/// What has to come along with it where something is changed.
inline constexpr std::string_view kCsrfHeader = "X-Hydroprint-Csrf";

/// How callers say who they are, as OpenAPI has it (components/securitySchemes).
[[nodiscard]] nlohmann::ordered_json security_schemes();

/// What an operation needs of them.
/// @param is_open  whoever reaches the daemon may call it
[[nodiscard]] nlohmann::ordered_json security_of(bool is_open, const std::string& http_method);

}  // namespace hydroprint::rest
