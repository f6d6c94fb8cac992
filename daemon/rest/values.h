#pragma once

#include <string>

#include "daemon/rest/routes.h"
#include "sim/base/result.h"

namespace google::protobuf {
class Message;
}  // namespace google::protobuf

namespace hydroprint::rest {

/// Sets a field, or appends to a repeated one, from text in a path or a query. Numbers are decimal,
/// bools "true" or "false", enums by name or number, bytes base64; Timestamp, Duration and
/// FieldMask are as in JSON, without the quotes. `text` is UTF-8 without NUL.
/// Returns kInvalidArgument, PARAMETER_INVALID, with the field, for:
/// - text that is not a valid, finite value in range;
/// - a map, or a message that JSON writes as an object;
/// - a second member of a oneof.
[[nodiscard]] Status set_from_text(google::protobuf::Message& message, const FieldPath& path,
                                   const std::string& text);

/// Returns the error for a wrong field in path or query: kInvalidArgument, PARAMETER_INVALID.
[[nodiscard]] tl::unexpected<Error> bad_parameter(const std::string& field,
                                                  const std::string& what);

}  // namespace hydroprint::rest
