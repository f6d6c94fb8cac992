// Either a request body is refused with a one-line error, or another parser also accepts it as
// JSON, and the message can be written and read again.
#include <google/protobuf/util/message_differencer.h>

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "daemon/rest/json_text.h"
#include "daemon/rest/percent.h"
#include "hydroprint/v1/job.pb.h"
#include "proto/write_json.h"
#include "tests/daemon/rest/rules/rules.pb.h"
#include "tests/fuzz/expect.h"

namespace hydroprint::fuzz {
namespace {

template <class Message>
void try_body(std::string_view text) {
  Message message;
  const Status status = rest::read_json(text, message);
  if (!status) {
    HP_EXPECT(status.error().code == Code::kInvalidArgument);
    HP_EXPECT(status.error().reason == ErrorReason::JSON_INVALID);
    HP_EXPECT(status.error().message.find('\n') == std::string::npos);
    HP_EXPECT(rest::not_utf8_at(status.error().message) == std::string::npos);
    return;
  }
  HP_EXPECT(nlohmann::json::accept(text));
  const auto written = write_json(message);
  HP_EXPECT(written.has_value());
  Message again;
  HP_EXPECT(rest::read_json(*written, again).has_value());
  HP_EXPECT(google::protobuf::util::MessageDifferencer::Equals(message, again));
}

}  // namespace
}  // namespace hydroprint::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  hydroprint::fuzz::try_body<hydroprint::rest::test::Everything>(text);
  hydroprint::fuzz::try_body<hydroprint::v1::Job>(text);
  return 0;
}
