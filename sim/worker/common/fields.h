#pragma once

#include <string>

#include "sim/base/result.h"

namespace google::protobuf {
class FieldDescriptor;
class Message;
}  // namespace google::protobuf

namespace hydroprint::worker {

/// Adds the name of the message in which the field of an error is: "film" becomes "film.film".
[[nodiscard]] Error in_message(const std::string& message, Error error);

/// Returns "--ink-passes" for "ink_passes" and for "film.ink_passes"; "--immersions: [1].depth_mm"
/// for a field in a list.
[[nodiscard]] std::string flag_of(const std::string& field);

/// True if only a daemon can resolve the field: the name of a job or calibration, or an option of
/// such a field. A daemon replaces it with files and values before a worker starts.
[[nodiscard]] bool is_reference(const google::protobuf::FieldDescriptor& field);

/// Checks the numbers and choices of a spec. Fails with fail_field() for the first one that is out
/// of range (kOutOfRange; kInvalidArgument for whole numbers) or unknown (kInvalidArgument).
[[nodiscard]] Status check_fields(const google::protobuf::Message& spec);

}  // namespace hydroprint::worker
