#pragma once

#include <string>

#include "daemon/http/artifact_path.h"
#include "daemon/http/protocol/exchange.h"
#include "daemon/http/server_context.h"

namespace hydroprint::http {

/// Answers a request for an artifact, the whole file or a range of bytes.
/// @return the route name for the metrics
[[nodiscard]] Task<std::string> answer_download(ServerContext& server, Exchange& exchange,
                                                ArtifactPath target);

}  // namespace hydroprint::http
