#pragma once

#include <string>
#include <string_view>

#include "sim/base/result.h"

namespace google::protobuf {
class Message;
}  // namespace google::protobuf

namespace hydroprint::rest {

/// Reads a JSON object into an empty message, as the proto3 JSON mapping says, and strictly.
/// Refused (kInvalidArgument, JSON_INVALID, metadata `field` where there is one; the message tells
/// the line and column, or the field): what is no JSON (comments, trailing commas, NaN, unquoted
/// names, bytes that are not UTF-8); more than 32 levels; a field that does not exist or is there
/// twice, be it under both of its names; NUL in a string; a number that is not finite, or that an
/// enum does not have; values of another type.
[[nodiscard]] Status read_json(std::string_view text, google::protobuf::Message& message);

/// Writes a message: field names in camelCase, all fields without presence, enums by name, int64 as
/// strings. Refused (kInternal): a message that has no JSON, such as an Any of an unknown type.
[[nodiscard]] Result<std::string> write_json(const google::protobuf::Message& message);

/// Refuses (kInvalidArgument, JSON_INVALID) numbers that are not finite or that an enum does not
/// have.
[[nodiscard]] Status check_values(const google::protobuf::Message& message);

}  // namespace hydroprint::rest
