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

/// A field of a message, or of one in it: the fields that lead there.
using FieldPath = std::vector<const google::protobuf::FieldDescriptor*>;

/// How deep a request may be nested, as JSON or by a name in the query; gRPC's limit is 100.
inline constexpr std::size_t kMostLevels = 32;

/// What of a request is its body.
enum class Body {
  kNone,   ///< nothing: what the path does not give is in the query
  kField,  ///< one field; the rest is in the query
  kAll,    ///< all that the path does not give; there is no query
};

/// One way to call a method over HTTP: google.api.http, read and checked.
struct Route {
  const google::protobuf::MethodDescriptor* method = nullptr;
  std::string http_method;  ///< "GET"
  PathTemplate path;
  std::vector<FieldPath> path_fields;  ///< of path.variables
  Body body = Body::kNone;
  const google::protobuf::FieldDescriptor* body_field = nullptr;  ///< of Body::kField
  bool stops_motion = false;  ///< access.proto; body and query are ignored
};

/// Full names of the services of package hydroprint.v1 ("hydroprint.v1.JobService").
[[nodiscard]] const std::vector<std::string>& api_services();

/// "/hydroprint.v1.JobService/CreateJob", as gRPC calls it.
[[nodiscard]] std::string rpc_name(const google::protobuf::MethodDescriptor& method);

/// Routes of these services, which must be linked in; methods without an annotation have none.
/// Refused (kInternal, for they are the program's own): what Transcoder::make() says.
[[nodiscard]] Result<std::vector<Route>> read_routes(const std::vector<std::string>& services);

/// The field of this name or JSON name; null: none.
[[nodiscard]] const google::protobuf::FieldDescriptor* field_called(
    const google::protobuf::Descriptor& message, const std::string& name);

/// Finds the field at "job.display_name" by its name or its JSON name ("job.displayName"). Refused
/// (kInvalidArgument): no such field, one in something repeated or in what is no message, or one
/// deeper than kMostLevels; the message does not name it.
[[nodiscard]] Result<FieldPath> find_field(const google::protobuf::Descriptor& message,
                                           std::string_view path);

/// "job.display_name".
[[nodiscard]] std::string path_text(const FieldPath& path);

/// Whether the field is a message that JSON writes as one string or number: Timestamp, Duration,
/// FieldMask and the wrappers.
[[nodiscard]] bool is_written_as_value(const google::protobuf::FieldDescriptor& field);

/// Whether it is one of the wrappers, which hold one value (BoolValue, StringValue, ...).
[[nodiscard]] bool is_wrapper(const google::protobuf::FieldDescriptor& field);

}  // namespace hydroprint::rest
