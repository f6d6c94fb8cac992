#pragma once

#include <string>

#include "daemon/http/artifact_path.h"
#include "daemon/http/protocol/exchange.h"
#include "daemon/http/server_context.h"

namespace hydroprint::http {

/// Answers a request for the bytes of an artifact, the whole file or a range.
/// @return the name under which the request is counted
[[nodiscard]] Task<std::string> answer_download(ServerContext& server, Exchange& exchange,
                                                ArtifactPath target);

}  // namespace hydroprint::http
