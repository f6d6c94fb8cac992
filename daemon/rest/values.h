#pragma once

#include <string>

#include "daemon/rest/routes.h"
#include "sim/base/result.h"

namespace google::protobuf {
class Message;
}  // namespace google::protobuf

namespace hydroprint::rest {

/// Sets a field, or adds to one that is repeated, from the text that a path or a query has for it:
/// numbers in decimal, "true" or "false", enums by name or number, bytes in base64, Timestamp,
/// Duration and FieldMask as JSON has them without the quotes. `text` is UTF-8 without NUL. Refused
/// (kInvalidArgument, PARAMETER_INVALID, metadata `field`): text that is no such value, or none
/// that is finite or fits; a map, or a message that JSON writes as an object; a second member of a
/// oneof.
[[nodiscard]] Status set_from_text(google::protobuf::Message& message, const FieldPath& path,
                                   const std::string& text);

/// kInvalidArgument, PARAMETER_INVALID: what is wrong with a field of path or query.
[[nodiscard]] tl::unexpected<Error> bad_parameter(const std::string& field,
                                                  const std::string& what);

}  // namespace hydroprint::rest
