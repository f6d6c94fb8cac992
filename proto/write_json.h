#pragma once

#include <string>

#include "sim/base/result.h"

namespace google::protobuf {
class Message;
}  // namespace google::protobuf

namespace hydroprint {

/// Writes a message as JSON on one line, for REST and for `hydroprint --json`: field names in
/// camelCase, fields without presence even if they have the default value, enums by name, int64 as
/// strings, times in RFC 3339.
/// Returns kInternal for a message without a JSON form, such as an Any of unknown type.
[[nodiscard]] Result<std::string> write_json(const google::protobuf::Message& message);

/// Returns a message as the text of a JSON file: indented, field names as in the .proto file, other
/// values as in write_json(). Same error.
[[nodiscard]] Result<std::string> json_file_of(const google::protobuf::Message& message);

}  // namespace hydroprint
