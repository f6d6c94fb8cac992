// The rig over HTTP, with the virtual rig as the drive.
#include <chrono>

#include "tests/daemon/api/rig_support.h"
#include "tests/daemon/http/http_client.h"

namespace hydroprint::tests {
namespace {

class HttpRig : public RigTest {
 protected:
  HttpAnswer post(const std::string& target, const nlohmann::json& body = {}) {
    return ask(daemon.http(), "POST", target, body.is_null() ? "" : body.dump());
  }
};

TEST_F(HttpRig, StopNeedsNoLeaseAndDoesNotWait) {
  ann.make_ready();
  ASSERT_TRUE(ann.move_to(200, 5).ok());
  ASSERT_TRUE(rig.gets_to(5));
  // Opens the maximum number of streams, and calls that wait for missing bodies.
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

// An unusual stop request. `query` follows the path, and `rest` (header fields and body) follows
// the Host field.
struct OddStop {
  const char* name;
  std::string query, rest;
  bool is_answered = true;  // false: the client disconnects at once
};

std::string with_body(const std::string& body, const std::string& fields = "") {
  return fields + "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
}

std::vector<OddStop> odd_stops() {
  const std::string chunked = "Transfer-Encoding: chunked\r\n\r\n";
  const std::string promise = "Content-Length: 9\r\n\r\n";
  return {
      {"a field that does not exist", "", with_body(R"({"leaseId":"x"})")},
      {"a list", "", with_body("[]")},
      {"JSON that ends early", "", with_body(R"({"leaseId":)")},
      {"bytes", "", with_body(std::string("\0\xff\xfe\x01", 4))},
      {"a form", "", with_body("a=b", "Content-Type: application/x-www-form-urlencoded\r\n")},
      {"an unknown charset", "",
       with_body("{}", "Content-Type: application/json; charset=klingon\r\n")},
      {"an unknown content encoding", "", with_body("{}", "Content-Encoding: zstd\r\n")},
      {"a query", "?leaseId=x&%zz=%00&&", with_body("{}")},
      {"a name that is not ASCII", "", "Hydroprint-Owner: J\xc3\xbcrgen\r\n\r\n"},
      {"a key that is not ASCII", "", "Authorization: Bearer \xff\r\n\r\n"},
      {"a name that is too long", "", "Hydroprint-Owner: " + std::string(9000, 'x') + "\r\n\r\n"},
      {"a request id", "", "Idempotency-Key: \xff\r\nLast-Event-ID: x\r\n\r\n"},
      {"2 MiB", "", "Content-Length: 2097152\r\n\r\n" + std::string(4096, ' ')},
      {"a body that waits to be invited", "", "Expect: 100-continue\r\n" + promise},
      {"chunks", "", chunked + "2\r\n{}\r\n0\r\n\r\n"},
      {"chunks that are not framed", "", chunked + "zz\r\n{}"},
      {"an unknown transfer coding", "", "Transfer-Encoding: xchunked\r\n\r\n{}"},
      {"half a body", "", promise + "{"},
      {"half a body, and the client leaves", "", promise + "{", false},
      {"no body, and the client leaves", "", "\r\n", false},
  };
}

TEST_F(HttpRig, StopIgnoresBodyQueryAndHeader) {
  ann.make_ready();
  for (const OddStop& odd : odd_stops()) {
    SCOPED_TRACE(odd.name);
    // The target is so far that the axis does not reach it during the test.
    ASSERT_TRUE(ann.move_to(290, 5).ok());
    ASSERT_TRUE(rig.gets_to(5));
    HttpConnection connection(daemon.http());
    connection.send("POST /v1/rig:stop" + odd.query + " HTTP/1.1\r\nHost: localhost\r\n" +
                    odd.rest);
    if (odd.is_answered) {
      EXPECT_EQ(connection.read_answer().status, 200);
    } else {
      connection.close();
    }
    ASSERT_TRUE(rig.gets_to(0));
    ASSERT_TRUE(ann.becomes(v1::Rig::IDLE));
    EXPECT_EQ(ann.rig().motion().outcome(), v1::Motion::STOPPED);
  }
}

TEST_F(HttpRig, IgnoredBodyOfAStopIsNotTheNextRequest) {
  HttpConnection connection(daemon.http());
  const std::string evil = request_text("POST", "/v1/queue:pause", "{}");
  EXPECT_EQ(connection.ask("POST", "/v1/rig:stop", evil).status, 200);
  EXPECT_EQ(connection.ask("GET", "/v1/queue").json().at("paused"), false);
}

TEST_F(HttpRig, OtherSitesCannotStopTheRig) {
  ann.make_ready();
  ASSERT_TRUE(ann.move_to(290, 5).ok());
  ASSERT_TRUE(rig.gets_to(5));
  for (const char* field :
       {"Origin: http://elsewhere.example\r\n", "Sec-Fetch-Site: cross-site\r\n"}) {
    const HttpAnswer refused = ask(daemon.http(), "POST", "/v1/rig:stop", "{}", field);
    EXPECT_EQ(refused.reason(), "ORIGIN_FORBIDDEN") << field;
  }
  EXPECT_EQ(ann.rig().state(), v1::Rig::MOVING);
}

TEST_F(HttpRig, CancellingADipIgnoresBodyAndQuery) {
  ann.make_ready();
  ann.go_to(8);
  v1::DipSpec spec = short_dip();
  spec.set_depth_mm(100);
  const std::string name = ann.dip(spec).name();
  ann.guide_to(name, v1::DipStatus::DESCEND);
  ASSERT_TRUE(rig.gets_to(10));
  HttpConnection connection(daemon.http());
  connection.send("POST /v1/" + name +
                  ":cancel?leaseId=x HTTP/1.1\r\nHost: localhost\r\nContent-Length: 99\r\n\r\n{");
  EXPECT_EQ(connection.read_answer().status, 200);
  ASSERT_TRUE(rig.gets_to(0));
  EXPECT_EQ(ann.wait_for_end(name).state(), v1::Job::CANCELLED);
}

TEST_F(HttpRig, StreamShowsTheRigMoving) {
  ann.make_ready();
  HttpConnection stream(daemon.http());
  stream.send(request_text("GET", "/v1/events:watch?topics=rig"));
  EXPECT_EQ(stream.read_head().status, 200);
  EXPECT_EQ(stream.read_event().kind, "begin");
  const nlohmann::json move = {{"leaseId", ann.lease_id}, {"positionMm", 12}, {"speedMmPerS", 10}};
  EXPECT_EQ(post("/v1/rig:moveTo", move).status, 200);
  std::int64_t latest = 0;
  int samples = 0;
  for (bool is_there = false; !is_there; ++samples) {
    const HttpEvent event = stream.read_event();
    EXPECT_EQ(event.id, "");
    const auto now = event.json().at("rig");
    const std::int64_t revision = std::stoll(now.at("revision").get<std::string>());
    EXPECT_GT(revision, latest);
    latest = revision;
    is_there = now.at("state") == "IDLE" && now.at("positionMm").get<double>() > 11.9;
  }
  EXPECT_GT(samples, 3);  // one second of motion, with up to ten messages per second
  EXPECT_LT(samples, 60);
  EXPECT_NE(
      ask(daemon.http(), "GET", "/metrics").body.find("hydroprint_rig_state{state=\"IDLE\"} 1\n"),
      std::string::npos);
}

TEST_F(HttpRig, MetricsTellWhatTheControlLoopGot) {
  ASSERT_TRUE(ann.becomes(v1::Rig::DISARMED));
  const v1::LinkQuality link = ann.rig().link_quality();
  ASSERT_NE(link.scheduling(), v1::LinkQuality::SCHEDULING_UNSPECIFIED);
  const std::string text = ask(daemon.http(), "GET", "/metrics").body;
  const auto has = [&](const std::string& line) {
    return text.find("\n" + line + "\n") != std::string::npos;
  };
  for (const auto each : {v1::LinkQuality::REAL_TIME, v1::LinkQuality::RAISED_PRIORITY,
                          v1::LinkQuality::NORMAL_PRIORITY}) {
    EXPECT_TRUE(has("hydroprint_rig_thread_scheduling{scheduling=\"" +
                    v1::LinkQuality::Scheduling_Name(each) + "\"} " +
                    (each == link.scheduling() ? "1" : "0")));
  }
  EXPECT_TRUE(
      has(std::string("hydroprint_rig_memory_locked ") + (link.memory_locked() ? "1" : "0")));
  EXPECT_NE(text.find("\nhydroprint_drive_late_polls_total "), std::string::npos);
  EXPECT_LE(link.late_polls(), link.polls());
  EXPECT_NE(text.find("\nhydroprint_drive_reply_seconds_bucket{le=\"0.001\"} "), std::string::npos);
  EXPECT_NE(text.find("\nhydroprint_drive_reply_seconds_bucket{le=\"0.2\"} "), std::string::npos);
  EXPECT_NE(text.find("\nhydroprint_drive_reply_seconds_sum "), std::string::npos);
}

TEST_F(HttpRig, BadRepliesOfTheDriveAreCounted) {
  ASSERT_TRUE(ann.becomes(v1::Rig::DISARMED));
  rig.act("fault drop 1");
  ASSERT_TRUE(wait_until([&] { return ann.rig().link_quality().retried_reads() == 1; }));
  const v1::LinkQuality link = ann.rig().link_quality();
  EXPECT_EQ(link.unanswered_requests(), 1U);
  EXPECT_EQ(link.damaged_replies(), 0U);
  EXPECT_EQ(link.missed_polls(), 0U);
  EXPECT_EQ(ann.rig().state(), v1::Rig::DISARMED);
  ASSERT_EQ(link.reply_times_size(), 9);
  EXPECT_EQ(link.reply_times(0).at_most_s(), 0.001);
  EXPECT_FALSE(link.reply_times(8).has_at_most_s());
  std::uint64_t replies = 0;
  for (const auto& bucket : link.reply_times()) replies += bucket.replies();
  EXPECT_GE(replies, link.polls() - 2);
  EXPECT_GT(link.reply_time_sum_s(), 0);
  EXPECT_NE(
      ask(daemon.http(), "GET", "/metrics").body.find("\nhydroprint_drive_retried_reads_total 1\n"),
      std::string::npos);
}

TEST_F(HttpRig, ThousandsOfConnectionsDoNotDelayTheRig) {
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
