#pragma once

#include <google/protobuf/descriptor.h>

namespace hydroprint::rest {

/// Returns the int64 field with this name that is not repeated; null if there is none.
[[nodiscard]] inline const google::protobuf::FieldDescriptor* number_called(
    const google::protobuf::Descriptor& message, const char* name) {
  const auto* field = message.FindFieldByName(name);
  const bool is_number = field != nullptr && !field->is_repeated() &&
                         field->cpp_type() == google::protobuf::FieldDescriptor::CPPTYPE_INT64;
  return is_number ? field : nullptr;
}

/// Returns whether a stream can be resumed: its messages have `seq`, its request has `after_seq`.
[[nodiscard]] inline bool is_resumable(const google::protobuf::MethodDescriptor& method) {
  return method.server_streaming() && number_called(*method.output_type(), "seq") != nullptr &&
         number_called(*method.input_type(), "after_seq") != nullptr;
}

}  // namespace hydroprint::rest
