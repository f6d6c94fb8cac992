#pragma once

#include <string>

#include "sim/base/result.h"

namespace google::protobuf {
class FieldDescriptor;
class Message;
}  // namespace google::protobuf

namespace hydroprint::worker {

/// An error about a field of the spec. Its metadata holds the field's name ("dpi") and its message
/// only the problem; name_field() combines the two.
[[nodiscard]] tl::unexpected<Error> fail_field(Code code, const std::string& field,
                                               std::string problem);

/// Adds the field to the error's message as the user wrote it: "--ink-passes: ..." for flags,
/// "ink_passes: ..." for a spec. Errors without a field are returned unchanged.
[[nodiscard]] Error name_field(Error error, bool as_flag);

/// "--ink-passes" for "ink_passes".
[[nodiscard]] std::string flag_of(const std::string& field);

/// True if only a daemon can resolve the field: the name of a job or calibration, or an option of
/// such a field. A daemon replaces it with files and values before a worker starts.
[[nodiscard]] bool is_reference(const google::protobuf::FieldDescriptor& field);

/// Checks the numbers and choices of a spec. Fails with fail_field() for the first one that is out
/// of range (kOutOfRange; kInvalidArgument for whole numbers) or unknown (kInvalidArgument).
[[nodiscard]] Status check_fields(const google::protobuf::Message& spec);

}  // namespace hydroprint::worker
