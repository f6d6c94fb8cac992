#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "daemon/http/in_process_channel.h"
#include "daemon/http/protocol/header_fields.h"
#include "daemon/http/protocol/request_parser.h"
#include "sim/base/result.h"

namespace hydroprint::http {

/// How to handle a header field that is not printable ASCII, which gRPC cannot carry.
enum class Unprintable {
  kRefuse,   ///< SPEC_INVALID
  kReplace,  ///< replaces each such byte with '?', so that a stop is never refused
};

/// The metadata that identifies the caller to the services: authorization, hydroprint-owner,
/// hydroprint-session, hydroprint-peer.
[[nodiscard]] Result<InProcessChannel::Metadata> metadata_of(
    const Head& head, const std::string& peer, Unprintable unprintable = Unprintable::kRefuse);

/// The value of a cookie; nullopt if it is not sent.
[[nodiscard]] std::optional<std::string_view> cookie(const HeaderFields& fields,
                                                     std::string_view name);

}  // namespace hydroprint::http
