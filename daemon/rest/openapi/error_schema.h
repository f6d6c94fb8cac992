#pragma once

#include <nlohmann/json.hpp>

#include "daemon/rest/openapi/schemas.h"

namespace hydroprint::rest {

/// Returns the schema of the JSON that error_answer() writes. Adds ErrorReason to `schemas`.
[[nodiscard]] nlohmann::ordered_json error_schema(Schemas& schemas);

}  // namespace hydroprint::rest
