#pragma once

#include <string>

#include "sim/base/result.h"

namespace hydroprint::rest {

/// OpenAPI 3.0.3 document of all routes: those of the Transcoder, by the same descriptors and with
/// the .proto files' comments, and other_routes(). The same at every call. Refused (kInternal) as
/// Transcoder::make() refuses, and if two operations have the same name or place.
[[nodiscard]] Result<std::string> openapi();

}  // namespace hydroprint::rest
