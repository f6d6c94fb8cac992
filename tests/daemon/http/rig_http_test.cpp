// The rig over HTTP, with the virtual rig at the other end of the wire.
#include <chrono>

#include "tests/daemon/http/http_client.h"
#include "tests/daemon/rig_support.h"

namespace hydroprint::tests {
namespace {

class HttpRig : public RigTest {
 protected:
  HttpAnswer post(const std::string& target, const nlohmann::json& body = {}) {
    return ask(daemon.http(), "POST", target, body.is_null() ? "" : body.dump());
  }
};

TEST_F(HttpRig, AStopNeedsNothingAndWaitsForNobody) {
  ann.make_ready();
  ASSERT_TRUE(ann.move_to(200, 5).ok());
  ASSERT_TRUE(rig.gets_to(5));
  // Every stream that there may be, and calls that hang behind bodies that do not come.
  std::vector<HttpConnection> busy;
  for (int i = 0; i < 300; ++i) {
    busy.emplace_back(daemon.http());
    busy.back().send(i % 3 == 0 ? request_text("GET", "/v1/events:watch")
                                : "POST /v1/jobs HTTP/1.1\r\nHost: localhost\r\nContent-Length: "
                                  "9\r\n\r\n{");
  }
  const HttpAnswer stopped = post("/v1/rig:stop");
  EXPECT_EQ(stopped.status, 200);
  EXPECT_TRUE(rig.gets_to(0, 1));
}

TEST_F(HttpRig, APageSeesTheRigMove) {
  ann.make_ready();
  HttpConnection stream(daemon.http());
  stream.send(request_text("GET", "/v1/events:watch?topics=rig"));
  EXPECT_EQ(stream.read_head().status, 200);
  EXPECT_EQ(stream.read_event().kind, "begin");
  const nlohmann::json move = {{"leaseId", ann.lease_id}, {"positionMm", 12}, {"speedMmPerS", 10}};
  EXPECT_EQ(post("/v1/rig:moveTo", move).status, 200);
  int samples = 0;
  for (bool is_there = false; !is_there; ++samples) {
    const HttpEvent event = stream.read_event();
    EXPECT_EQ(event.id, "");
    const auto now = event.json().at("rig");
    is_there = now.at("state") == "IDLE" && now.at("positionMm").get<double>() > 11.9;
  }
  EXPECT_GT(samples, 3);  // a second's way, at most ten a second
  EXPECT_LT(samples, 60);
  EXPECT_NE(
      ask(daemon.http(), "GET", "/metrics").body.find("hydroprint_rig_state{state=\"IDLE\"} 1\n"),
      std::string::npos);
}

TEST_F(HttpRig, ThousandsOfConnectionsDoNotTouchTheRigsThread) {
  ann.make_ready();
  const auto skipped = ann.rig().link_quality().skipped_polls();
  const auto missed = ann.rig().link_quality().missed_polls();
  std::vector<HttpConnection> idle;
  for (int i = 0; i < 900; ++i) idle.emplace_back(daemon.http());
  ann.go_to(20);
  EXPECT_EQ(ann.rig().link_quality().missed_polls(), missed);
  RecordProperty("skipped_polls",
                 std::to_string(ann.rig().link_quality().skipped_polls() - skipped));
}

}  // namespace
}  // namespace hydroprint::tests
