#pragma once

#include <string>
#include <string_view>

namespace hydroprint::http {

/// What kind of event a streamed message is: the field that is set of its oneof ("job", "rig"),
/// else what the method watches: "/hydroprint.v1.JobService/WatchJob" -> "job"; "begin" for a
/// message whose oneof is not set.
[[nodiscard]] std::string event_kind(std::string_view method, const std::string& message);

/// One server-sent event. Without the line `id` if that is empty.
/// @param json  on one line
[[nodiscard]] std::string event_text(std::string_view id, std::string_view kind,
                                     std::string_view json);

}  // namespace hydroprint::http
