#pragma once

#include "sim/base/result.h"

namespace google::protobuf {
class Message;
}

namespace hydroprint::daemon {

/// Checks a message against the rules of its fields. Films and paper sizes are parsed as in the
/// worker.
/// @return kInvalidArgument, which lists all wrong fields (rest::bad_request())
[[nodiscard]] Status check_fields(const google::protobuf::Message& message);

}  // namespace hydroprint::daemon
