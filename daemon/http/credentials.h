#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "daemon/auth/account.h"
#include "daemon/http/in_process_channel.h"
#include "daemon/http/protocol/exchange.h"
#include "daemon/http/protocol/header_fields.h"
#include "daemon/http/protocol/request_parser.h"
#include "daemon/http/server_context.h"
#include "sim/base/result.h"

namespace hydroprint::http {

/// Handling of header fields that are not printable ASCII, which gRPC cannot transport.
enum class Unprintable {
  kRefuse,   ///< rejects the request with SPEC_INVALID
  kReplace,  ///< replaces each such byte with '?', so that a stop is never refused
};

/// Returns the credentials in a request's head: Authorization, Hydroprint-Owner, and the session
/// cookie.
[[nodiscard]] Result<auth::Credentials> credentials_in(
    const Head& head, const std::string& peer, Unprintable unprintable = Unprintable::kRefuse);

/// Determines the caller of an API method from the request's head and checks the role, before the
/// body is read.
/// @param method  "/hydroprint.v1.JobService/GetJob"
/// @return metadata that identifies the caller to the services
[[nodiscard]] Result<InProcessChannel::Metadata> admit(const ServerContext& server,
                                                       Exchange& exchange,
                                                       const std::string& method);

/// Returns the value of a cookie; nullopt if it was not sent.
[[nodiscard]] std::optional<std::string_view> cookie(const HeaderFields& fields,
                                                     std::string_view name);

}  // namespace hydroprint::http
