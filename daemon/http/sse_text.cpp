#include "daemon/http/sse_text.h"

#include <google/protobuf/message.h>

#include <algorithm>
#include <memory>

#include "daemon/http/method.h"

namespace hydroprint::http {
namespace {

namespace pb = google::protobuf;

// Returns the object that a method watches: "job" for "/hydroprint.v1.JobService/WatchJob".
std::string watched(std::string_view method) {
  constexpr std::string_view kWatch = "Watch";
  method.remove_prefix(std::min(method.rfind('/') + 1, method.size()));
  if (method.starts_with(kWatch)) method.remove_prefix(kWatch.size());
  std::string name(method);
  std::transform(name.begin(), name.end(), name.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  return name;
}

}  // namespace

std::string event_kind(std::string_view method, const std::string& message) {
  const pb::MethodDescriptor* called = method_called(method);
  const pb::Descriptor* type = called == nullptr ? nullptr : called->output_type();
  if (type == nullptr || type->real_oneof_decl_count() == 0) return watched(method);
  const pb::Message* prototype = pb::MessageFactory::generated_factory()->GetPrototype(type);
  const std::unique_ptr<pb::Message> parsed(prototype->New());
  if (!parsed->ParseFromString(message)) return watched(method);
  const auto* field =
      parsed->GetReflection()->GetOneofFieldDescriptor(*parsed, type->oneof_decl(0));
  return field == nullptr ? "begin" : field->name();
}

std::string event_text(std::string_view id, std::string_view kind, std::string_view json) {
  std::string text;
  if (!id.empty()) text.append("id: ").append(id).append("\n");
  text.append("event: ").append(kind).append("\ndata: ").append(json).append("\n\n");
  return text;
}

}  // namespace hydroprint::http
