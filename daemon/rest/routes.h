#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "daemon/rest/path_template.h"
#include "sim/base/result.h"

namespace google::protobuf {
class Descriptor;
class FieldDescriptor;
class MethodDescriptor;
}  // namespace google::protobuf

namespace hydroprint::rest {

/// The path to a field, through the messages that contain it.
using FieldPath = std::vector<const google::protobuf::FieldDescriptor*>;

/// Maximum nesting of a request, in JSON or in a query name; gRPC's limit is 100.
inline constexpr std::size_t kMostLevels = 32;

/// The part of the request message that is in the body.
enum class Body {
  kNone,   ///< no body: fields that are not in the path are in the query
  kField,  ///< one field; the rest is in the query
  kAll,    ///< all fields that are not in the path; there is no query
};

/// An HTTP binding of a method: a parsed and checked google.api.http rule.
struct Route {
  const google::protobuf::MethodDescriptor* method = nullptr;
  std::string http_method;  ///< "GET"
  PathTemplate path;
  std::vector<FieldPath> path_fields;  ///< same order as path.variables
  Body body = Body::kNone;
  const google::protobuf::FieldDescriptor* body_field = nullptr;  ///< only for Body::kField
  bool stops_motion = false;  ///< access.proto; if true, body and query are ignored
};

/// Returns the full names of the services of package hydroprint.v1 ("hydroprint.v1.JobService").
[[nodiscard]] const std::vector<std::string>& api_services();

/// Returns the method's gRPC name: "/hydroprint.v1.JobService/CreateJob".
[[nodiscard]] std::string rpc_name(const google::protobuf::MethodDescriptor& method);

/// Returns the routes of these services, which must be linked in; methods without an annotation
/// have none. Returns the errors of Transcoder::make() (kInternal, because the rules are part of
/// the program).
[[nodiscard]] Result<std::vector<Route>> read_routes(const std::vector<std::string>& services);

/// Returns the field with this name or JSON name; null if there is none.
[[nodiscard]] const google::protobuf::FieldDescriptor* field_called(
    const google::protobuf::Descriptor& message, const std::string& name);

/// Finds the field at "job.display_name" by its name or its JSON name ("job.displayName"). Returns
/// kInvalidArgument for an unknown field, a field inside a repeated field or a scalar, and a path
/// deeper than kMostLevels. The error message does not name the field.
[[nodiscard]] Result<FieldPath> find_field(const google::protobuf::Descriptor& message,
                                           std::string_view path);

/// Joins the names of the fields: "job.display_name".
[[nodiscard]] std::string path_text(const FieldPath& path);

/// Returns whether JSON represents the field's message as one string or number: Timestamp,
/// Duration, FieldMask and the wrappers.
[[nodiscard]] bool is_written_as_value(const google::protobuf::FieldDescriptor& field);

/// Returns whether the type of the field is a wrapper, a message with one value (BoolValue,
/// StringValue, ...).
[[nodiscard]] bool is_wrapper(const google::protobuf::FieldDescriptor& field);

}  // namespace hydroprint::rest
