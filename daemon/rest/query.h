#pragma once

#include <string_view>

#include "daemon/rest/routes.h"
#include "sim/base/result.h"

namespace google::protobuf {
class Message;
}  // namespace google::protobuf

namespace hydroprint::rest {

/// Sets the fields in the query of a request ("pageSize=2&states=QUEUED&states=RUNNING"),
/// under their names or JSON names. An extra "&" is allowed. Returns kInvalidArgument with
/// URL_INVALID or PARAMETER_INVALID for:
/// - a name without "=", or the name of an unknown field;
/// - a field that belongs in the path or the body;
/// - a field that occurs twice but is not repeated;
/// - a value that set_from_text() rejects.
[[nodiscard]] Status read_query(std::string_view query, const Route& route,
                                google::protobuf::Message& request);

}  // namespace hydroprint::rest
