// Ids of events, and resuming streams after an event.
#include <gtest/gtest.h>

#include "tests/daemon/rest/rules/rules.pb.h"
#include "tests/daemon/rest/rules_requests.h"

namespace hydroprint::rest {
namespace {

using test::Everything;

TEST(Stream, EventsHaveTheSeqOfTheirMessage) {
  test::Numbered message;
  message.set_seq(9007199254740993);
  const std::string method = "/hydroprint.rest.test.Rules/Stream";
  EXPECT_EQ(rules().event_id(method, message.SerializeAsString()), "9007199254740993");
  EXPECT_EQ(rules().event_id("/hydroprint.rest.test.Rules/PlainStream", ""), "");
  EXPECT_EQ(rules().event_id("/hydroprint.rest.test.Rules/Query", ""), "");
  EXPECT_EQ(rules().event_id("/hydroprint.rest.test.Rules/None", ""), "");
}

TEST(Stream, ResumesAfterTheLastEvent) {
  const auto call = rules().read("GET", "/r/stream?afterSeq=3&text=a", "");
  ASSERT_TRUE(call);
  EXPECT_TRUE(call->streams);
  const auto resumed = rules().resume(*call, "17");
  ASSERT_TRUE(resumed) << resumed.error().message;
  Everything request;
  ASSERT_TRUE(request.ParseFromString(resumed->request));
  EXPECT_EQ(request.after_seq(), 17);
  EXPECT_EQ(request.text(), "a");
  for (const char* id : {"", "-1", "x", "1x", " 1", "99999999999999999999"}) {
    const auto refused = rules().resume(*call, id);
    ASSERT_FALSE(refused) << id;
    EXPECT_EQ(refused.error().reason, ErrorReason::PARAMETER_INVALID);
  }
  const auto plain = rules().read("GET", "/r/plainStream", "");
  EXPECT_TRUE(rules().resume(*plain, "x"));
}

}  // namespace
}  // namespace hydroprint::rest
