#pragma once

#include <string_view>

#include "daemon/rest/routes.h"
#include "sim/base/result.h"

namespace google::protobuf {
class Message;
}  // namespace google::protobuf

namespace hydroprint::rest {

/// Sets the fields that the query of a request gives ("pageSize=2&states=QUEUED&states=RUNNING"),
/// under their names or JSON names. An extra "&" is allowed. Refuses (kInvalidArgument:
/// URL_INVALID, PARAMETER_INVALID):
/// - a name without "=", or of an unknown field;
/// - a field that belongs in the path or the body;
/// - a field that occurs twice but is not repeated;
/// - any value that set_from_text() refuses.
[[nodiscard]] Status read_query(std::string_view query, const Route& route,
                                google::protobuf::Message& request);

}  // namespace hydroprint::rest
