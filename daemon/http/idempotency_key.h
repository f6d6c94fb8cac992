#pragma once

#include <string>
#include <string_view>

namespace hydroprint::http {

/// A request with the header Idempotency-Key as its `request_id`, which says the same; as it is if
/// it has one of its own, or its method takes none.
/// @param method  "/hydroprint.v1.JobService/CreateJob"
/// @param request  serialised
[[nodiscard]] std::string with_request_id(std::string_view method, const std::string& request,
                                          std::string_view key);

}  // namespace hydroprint::http
