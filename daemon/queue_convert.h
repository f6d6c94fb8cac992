#pragma once

#include "daemon/call.h"
#include "hydroprint/v1/queue_service.pb.h"

namespace hydroprint::daemon {

/// The queue as the API shows it now.
[[nodiscard]] Result<v1::Queue> queue_message(const Backend& backend);

}  // namespace hydroprint::daemon
