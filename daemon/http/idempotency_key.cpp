#include "daemon/http/idempotency_key.h"

#include <google/protobuf/message.h>

#include <memory>

#include "daemon/http/method.h"

namespace hydroprint::http {

std::string with_request_id(std::string_view method, const std::string& request,
                            std::string_view key) {
  namespace pb = google::protobuf;
  const pb::MethodDescriptor* called = method_called(method);
  if (called == nullptr) return request;
  const pb::FieldDescriptor* field = called->input_type()->FindFieldByName("request_id");
  if (field == nullptr || field->type() != pb::FieldDescriptor::TYPE_STRING) return request;
  const std::unique_ptr<pb::Message> message(
      pb::MessageFactory::generated_factory()->GetPrototype(called->input_type())->New());
  const pb::Reflection& reflection = *message->GetReflection();
  if (!message->ParseFromString(request)) return request;
  if (!reflection.GetString(*message, field).empty()) return request;
  reflection.SetString(message.get(), field, std::string(key));
  return message->SerializeAsString();
}

}  // namespace hydroprint::http
