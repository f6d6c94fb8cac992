#pragma once

#include <string>

#include "sim/base/result.h"

namespace hydroprint::rest {

/// Returns the OpenAPI 3.0.3 document of all routes: those of the Transcoder, from the same
/// descriptors and with the comments of the .proto files, and other_routes(). The text is the same
/// on every call. Returns kInternal for the same faults as Transcoder::make(), and for two
/// operations with the same name or the same path and method.
[[nodiscard]] Result<std::string> openapi();

}  // namespace hydroprint::rest
