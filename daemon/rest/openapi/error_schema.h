#pragma once

#include <nlohmann/json.hpp>

#include "daemon/rest/openapi/schemas.h"

namespace hydroprint::rest {

/// Schema of what error_answer() writes. ErrorReason is added to `schemas`.
[[nodiscard]] nlohmann::ordered_json error_schema(Schemas& schemas);

}  // namespace hydroprint::rest
