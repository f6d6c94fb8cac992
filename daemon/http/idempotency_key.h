#pragma once

#include <string>
#include <string_view>

namespace hydroprint::http {

/// Sets the `request_id` of a request to `key`, the value of the header Idempotency-Key. Returns
/// the request unchanged if it already has an id, or if its message has no such field.
/// @param method   "/hydroprint.v1.JobService/CreateJob"
/// @param request  serialised
[[nodiscard]] std::string with_request_id(std::string_view method, const std::string& request,
                                          std::string_view key);

}  // namespace hydroprint::http
