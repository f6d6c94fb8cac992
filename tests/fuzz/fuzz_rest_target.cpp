// Either a request line is refused with a one-line error, or it gives a request that can be parsed.
#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "daemon/rest/percent.h"
#include "daemon/rest/routes.h"
#include "daemon/rest/transcoder.h"
#include "tests/fuzz/expect.h"

namespace hydroprint::fuzz {
namespace {

namespace pb = google::protobuf;
using rest::Transcoder;

const Transcoder& transcoder() {
  static const Transcoder made = [] {
    auto services = rest::api_services();
    services.emplace_back("hydroprint.rest.test.Rules");
    return Transcoder::make(services).value();
  }();
  return made;
}

void check_refusal(const Error& error) {
  HP_EXPECT(error.message.find('\n') == std::string::npos && error.message.size() < 1000);
  HP_EXPECT(rest::not_utf8_at(error.message) == std::string::npos);
  HP_EXPECT(error.code == Code::kInvalidArgument || error.code == Code::kNotFound ||
            error.code == Code::kUnimplemented);
  HP_EXPECT(!error.reason.empty());
}

// All texts of a message can be used in file names, logs and responses: UTF-8 without NUL.
void check_texts(const pb::Message& message) {
  const pb::Reflection& look = *message.GetReflection();
  std::vector<const pb::FieldDescriptor*> fields;
  look.ListFields(message, &fields);
  for (const auto* field : fields) {
    const int count = field->is_repeated() ? look.FieldSize(message, field) : 1;
    for (int i = 0; i < count; ++i) {
      const bool one = !field->is_repeated();
      if (field->message_type() != nullptr) {
        check_texts(one ? look.GetMessage(message, field)
                        : look.GetRepeatedMessage(message, field, i));
      }
      if (field->type() != pb::FieldDescriptor::TYPE_STRING) continue;
      const std::string text =
          one ? look.GetString(message, field) : look.GetRepeatedString(message, field, i);
      HP_EXPECT(rest::not_utf8_at(text) == std::string::npos);
      HP_EXPECT(text.find('\0') == std::string::npos);
    }
  }
}

void try_request(std::string_view line) {
  const std::size_t blank = std::min(line.find(' '), line.size());
  const std::string_view http_method = line.substr(0, blank);
  const std::string_view target = line.substr(std::min(blank + 1, line.size()));
  const auto allowed = transcoder().methods_at(target);
  const auto call = transcoder().read(http_method, target, {});
  const bool is_allowed = std::count(allowed.begin(), allowed.end(), http_method) == 1;
  if (!call) {
    check_refusal(call.error());
    HP_EXPECT((call.error().code != Code::kInvalidArgument) || is_allowed || allowed.empty());
    return;
  }
  HP_EXPECT(is_allowed);
  std::string name = call->method.substr(1);
  std::replace(name.begin(), name.end(), '/', '.');
  const auto* method = pb::DescriptorPool::generated_pool()->FindMethodByName(name);
  HP_EXPECT(method != nullptr);
  const std::unique_ptr<pb::Message> request(
      pb::MessageFactory::generated_factory()->GetPrototype(method->input_type())->New());
  HP_EXPECT(request->ParseFromString(call->request));
  check_texts(*request);
}

}  // namespace
}  // namespace hydroprint::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  hydroprint::fuzz::try_request({reinterpret_cast<const char*>(data), size});
  return 0;
}
