#pragma once

#include "daemon/api/service_context.h"
#include "hydroprint/v1/queue_service.pb.h"

namespace hydroprint::daemon {

/// Returns the current queue as an API message.
[[nodiscard]] Result<v1::Queue> queue_message(const ServiceContext& backend);

}  // namespace hydroprint::daemon
