#include "proto/write_json.h"

#include <google/protobuf/message.h>
#include <google/protobuf/util/json_util.h>

#include "sim/base/utf8.h"

namespace hydroprint {

namespace pb = google::protobuf;

namespace {

Result<std::string> write(const pb::Message& message, pb::util::JsonPrintOptions options) {
  options.always_print_primitive_fields = true;
  std::string text;
  const auto status = pb::util::MessageToJsonString(message, &text, options);
  if (!status.ok()) {
    return fail(Code::kInternal, message.GetTypeName() + " cannot be written as JSON: " +
                                     one_line(status.message().ToString()));
  }
  return text;
}

}  // namespace

Result<std::string> write_json(const pb::Message& message) { return write(message, {}); }

Result<std::string> json_file_of(const pb::Message& message) {
  pb::util::JsonPrintOptions options;
  options.add_whitespace = true;
  options.preserve_proto_field_names = true;
  return write(message, options);
}

}  // namespace hydroprint
