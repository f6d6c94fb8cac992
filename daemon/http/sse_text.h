#pragma once

#include <string>
#include <string_view>

namespace hydroprint::http {

/// Returns the event kind of a streamed message: the field that is set in its oneof ("job", "rig"),
/// or "begin" if none is set. If the message has no oneof, returns the object that the method
/// watches: "job" for "/hydroprint.v1.JobService/WatchJob".
[[nodiscard]] std::string event_kind(std::string_view method, const std::string& message);

/// Formats one server-sent event, without the line `id` if that is empty.
/// @param json  the data of the event, on one line
[[nodiscard]] std::string event_text(std::string_view id, std::string_view kind,
                                     std::string_view json);

}  // namespace hydroprint::http
