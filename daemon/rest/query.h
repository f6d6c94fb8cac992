#pragma once

#include <string_view>

#include "daemon/rest/routes.h"
#include "sim/base/result.h"

namespace google::protobuf {
class Message;
}  // namespace google::protobuf

namespace hydroprint::rest {

/// Sets the fields that the query of a request gives ("pageSize=2&states=QUEUED&states=RUNNING"),
/// under their names or JSON names. Refused (kInvalidArgument: URL_INVALID, PARAMETER_INVALID): a
/// name without "=", a field that does not exist, one that path or body give, one that is given
/// twice but not repeated, and what set_from_text() refuses. "&" may stand at the end, or twice.
[[nodiscard]] Status read_query(std::string_view query, const Route& route,
                                google::protobuf::Message& request);

}  // namespace hydroprint::rest
