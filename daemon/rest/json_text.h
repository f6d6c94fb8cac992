#pragma once

#include <string_view>

#include "sim/base/result.h"

namespace google::protobuf {
class Message;
}  // namespace google::protobuf

namespace hydroprint::rest {

/// Reads a JSON object into an empty message, following the proto3 JSON mapping strictly. Returns
/// kInvalidArgument, JSON_INVALID, with line and column in `what`, or the field (also as metadata
/// `field`), for:
/// - text that is not valid JSON (comments, trailing commas, NaN, unquoted names, bytes that are
///   not UTF-8);
/// - more than 32 levels;
/// - an unknown field, or one that occurs twice, even if under both of its names;
/// - NUL in a string, a number that is not finite, an unknown enum number, a value of another type.
[[nodiscard]] Status read_json(std::string_view text, google::protobuf::Message& message,
                               std::string_view what = "request body");

/// Returns kInvalidArgument, JSON_INVALID for numbers that are not finite and unknown enum numbers.
[[nodiscard]] Status check_values(const google::protobuf::Message& message);

}  // namespace hydroprint::rest
