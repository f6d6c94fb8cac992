#pragma once

#include <string>

namespace hydroprint::rest {

/// What the .proto file says in front of something, by its full name ("hydroprint.v1.Job.state",
/// "hydroprint.v1.JobService.GetJob"; an enum's value as "hydroprint.v1.Job.State.QUEUED"); empty:
/// nothing.
[[nodiscard]] std::string comment_on(const std::string& full_name);

/// Its first sentence, on one line.
[[nodiscard]] std::string first_sentence(const std::string& comment);

}  // namespace hydroprint::rest
