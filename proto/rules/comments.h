#pragma once

#include <string>

namespace hydroprint::rules {

/// Returns the comment in front of an element in the .proto file, by full name:
/// "hydroprint.v1.Job.state", "hydroprint.v1.JobService.GetJob", or
/// "hydroprint.v1.Job.State.QUEUED" for an enum value. Empty if there is no comment.
[[nodiscard]] std::string comment_on(const std::string& full_name);

/// Returns the first sentence of a comment, on one line.
[[nodiscard]] std::string first_sentence(const std::string& comment);

/// Returns the default that a comment states in a sentence "Default: ...", on one line and without
/// backquotes; empty if the comment states no default.
[[nodiscard]] std::string stated_default(const std::string& comment);

}  // namespace hydroprint::rules
