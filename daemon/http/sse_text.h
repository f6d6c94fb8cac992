#pragma once

#include <string>
#include <string_view>

namespace hydroprint::http {

/// The event kind of a streamed message: the field set in its oneof ("job", "rig"), or "begin" if
/// none is set. Without a oneof, the object that the method watches:
/// "/hydroprint.v1.JobService/WatchJob" -> "job".
[[nodiscard]] std::string event_kind(std::string_view method, const std::string& message);

/// The text of one server-sent event, without the line `id` if that is empty.
/// @param json  on one line
[[nodiscard]] std::string event_text(std::string_view id, std::string_view kind,
                                     std::string_view json);

}  // namespace hydroprint::http
