#pragma once

#include <string>

#include "sim/base/result.h"

namespace google::protobuf {
class Message;
}

namespace hydroprint::worker {

/// An error about a field of the spec. Its metadata has the field's name ("dpi"), its message only
/// the problem; name_field() puts the two together.
[[nodiscard]] tl::unexpected<Error> fail_field(Code code, const std::string& field,
                                               std::string problem);

/// The error with the field in its message, in the words of the user: "--ink-passes: ..." for
/// flags, "ink_passes: ..." for a spec. Other errors stay as they are.
[[nodiscard]] Error name_field(Error error, bool as_flag);

/// "--ink-passes" for "ink_passes".
[[nodiscard]] std::string flag_of(const std::string& field);

/// Checks the numbers and choices of a spec. Fails with fail_field() for the first one that is out
/// of range (kOutOfRange; kInvalidArgument for whole numbers) or unknown (kInvalidArgument).
[[nodiscard]] Status check_fields(const google::protobuf::Message& spec);

}  // namespace hydroprint::worker
