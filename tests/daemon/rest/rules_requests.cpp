#include "tests/daemon/rest/rules_requests.h"

#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/daemon/rest/rules/rules.pb.h"

namespace hydroprint::rest {

const Transcoder& rules() {
  static const auto made = Transcoder::make({"hydroprint.rest.test.Rules"});
  if (!made) throw std::logic_error(made.error().message);
  return *made;
}

std::string read(const std::string& http_method, const std::string& target,
                 const std::string& body) {
  const auto call = rules().read(http_method, target, body);
  if (!call) {
    EXPECT_EQ(call.error().code, Code::kInvalidArgument) << call.error().message;
    EXPECT_EQ(call.error().message.find('\n'), std::string::npos) << call.error().message;
    EXPECT_LT(call.error().message.size(), 400U);
    return std::string(name_of(call.error().reason)) + " " + full_message(call.error());
  }
  test::Everything request;
  EXPECT_TRUE(request.ParseFromString(call->request));
  std::string text;
  EXPECT_TRUE(google::protobuf::util::MessageToJsonString(request, &text).ok());
  return text;
}

}  // namespace hydroprint::rest
