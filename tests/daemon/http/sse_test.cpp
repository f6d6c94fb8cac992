// Streams over HTTP, as EventSource sees them, through the daemon.
#include "tests/daemon/http/http_support.h"

namespace hydroprint::tests {
namespace {

class HttpEvents : public HttpTest {
 protected:
  HttpConnection watch(const std::string& target, const std::string& fields = "",
                       int receive_buffer_bytes = 0) {
    HttpConnection connection(daemon.http(), receive_buffer_bytes);
    connection.send(request_text("GET", target, "", fields));
    const HttpAnswer head = connection.read_head();
    EXPECT_EQ(head.status, 200);
    EXPECT_EQ(head.field("content-type"), "text/event-stream");
    EXPECT_EQ(head.field("cache-control"), "no-store");
    EXPECT_EQ(head.field("x-accel-buffering"), "no");
    return connection;
  }

  // Reads events up to and including the first of this kind.
  static std::vector<HttpEvent> until(HttpConnection& connection, const std::string& kind) {
    std::vector<HttpEvent> events;
    do {
      events.push_back(connection.read_event());
    } while (events.back().kind != kind && events.size() < 300);
    return events;
  }
};

TEST_F(HttpEvents, JobIsFollowedToItsEnd) {
  const std::string name = simulate("sleep 0.5");
  HttpConnection stream = watch("/v1/" + name + ":watch?afterSeq=0");
  const auto events = until(stream, "end");
  std::int64_t seq = -1;
  for (std::size_t i = 0; i + 1 < events.size(); ++i) {
    EXPECT_EQ(events[i].kind, "job");
    EXPECT_GT(std::stoll(events[i].id), seq);
    seq = std::stoll(events[i].id);
    EXPECT_EQ(events[i].json().at("seq"), events[i].id);
  }
  EXPECT_EQ(events[events.size() - 2].json().at("job").at("state"), "SUCCEEDED");
  EXPECT_TRUE(stream.is_stream_over());
  EXPECT_EQ(stream.ask("GET", "/v1/queue").status, 200);
}

TEST_F(HttpEvents, StreamResumesAfterTheLastEvent) {
  const std::string name = simulate("sleep 0.3");
  client.wait_for_end(name);
  const auto target = "/v1/" + name + ":watch?afterSeq=0";
  HttpConnection whole = watch(target);
  const auto all = until(whole, "end");
  ASSERT_GT(all.size(), 3U);
  HttpConnection rest = watch(target, "Last-Event-ID: " + all[1].id + "\r\n");
  const auto events = until(rest, "end");
  // A resumed stream begins with the current state of the job, then sends the events after the last
  // one.
  EXPECT_EQ(events.size(), all.size() - 1);
  EXPECT_EQ(events[1].id, all[2].id);
  const HttpAnswer never = get(target, "Last-Event-ID: 999999\r\n");
  EXPECT_EQ(never.status, 400);
  EXPECT_EQ(never.reason(), "EVENTS_GONE");
  EXPECT_EQ(get(target, "Last-Event-ID: x\r\n").reason(), "PARAMETER_INVALID");
}

TEST_F(HttpEvents, ErrorBeforeTheFirstEventIsANormalResponse) {
  EXPECT_EQ(get("/v1/jobs/77:watch").status, 404);
  const HttpAnswer topic = get("/v1/events:watch?topics=weather");
  EXPECT_EQ(topic.status, 400);
  EXPECT_EQ(topic.reason(), "SPEC_INVALID");
  EXPECT_EQ(get("/v1/events:watch?afterSeq=99999").reason(), "EVENTS_GONE");
}

TEST_F(HttpEvents, OneStreamHasAllTopics) {
  HttpConnection stream = watch("/v1/events:watch");
  const HttpEvent begin = stream.read_event();
  EXPECT_EQ(begin.kind, "begin");
  EXPECT_FALSE(begin.id.empty());
  const HttpEvent rig = stream.read_event();
  EXPECT_EQ(rig.kind, "rig");
  EXPECT_EQ(rig.id, "");
  EXPECT_EQ(rig.json().at("rig").at("state"), "OFFLINE");
  EXPECT_EQ(stream.read_event().kind, "lease");
  EXPECT_EQ(stream.read_event().json().at("queue").at("paused"), false);

  post("/v1/queue:pause", R"({"reason": "new film"})");
  const auto paused = until(stream, "queue");
  EXPECT_EQ(paused.back().json().at("queue").at("pauseReason"), "new film");
  post("/v1/rig/lease:acquire", R"({"purpose": "test"})");
  const auto held = until(stream, "lease").back().json();
  EXPECT_EQ(held.at("lease").at("lease").at("purpose"), "test");
  EXPECT_EQ(held.at("lease").at("lease").value("leaseId", ""), "");
  const std::string name = simulate("");
  const auto created = until(stream, "job").back().json();
  EXPECT_EQ(created.at("job").at("job").at("name"), name);
  EXPECT_EQ(created.at("job").at("event").at("state"), "QUEUED");
}

TEST_F(HttpEvents, AllJobsAppearInOneStream) {
  HttpConnection stream = watch("/v1/events:watch?topics=job");
  std::string seq = stream.read_event().id;
  std::vector<std::string> names;
  for (int i = 0; i < 5; ++i) names.push_back(simulate("# " + std::to_string(i)));
  std::size_t ended = 0;
  std::vector<std::string> seen;
  for (int i = 0; ended < names.size(); ++i) {
    const HttpEvent event = stream.read_event();
    const auto job = event.json().at("job");
    seen.push_back(event.id);
    if (job.at("event").at("state") == "SUCCEEDED") ++ended;
    seq = event.id;
    if (i % 3 == 2) {  // the page reconnects with the last id that it received
      stream = watch("/v1/events:watch?topics=job", "Last-Event-ID: " + seq + "\r\n");
      EXPECT_EQ(stream.read_event().kind, "begin");
    }
  }
  std::vector<std::string> all;
  for (const std::string& name : names) {
    for (const auto& event : client.events(name)) {
      if (event.kind() != v1::JobEvent::PROGRESS) all.push_back(std::to_string(event.seq()));
    }
  }
  for (const std::string& one : all) {
    EXPECT_NE(std::find(seen.begin(), seen.end(), one), seen.end()) << one;
  }
}

TEST_F(HttpEvents, ShutdownEndsTheStreamAndTheNextDaemonResumesIt) {
  const std::string name = simulate("sleep 30");
  client.wait_for(name, v1::Job::RUNNING);
  HttpConnection stream = watch("/v1/events:watch?topics=job&afterSeq=0");
  std::string seen;
  for (HttpEvent event; event.data.find("RUNNING") == std::string::npos; seen = event.id) {
    event = stream.read_event();
  }
  EXPECT_EQ(daemon.terminate(), 0);
  const auto last = until(stream, "error");
  EXPECT_NE(last.back().data.find("SHUTTING_DOWN"), std::string::npos) << last.back().data;
  for (const HttpEvent& event : last) {
    if (!event.id.empty()) seen = event.id;
  }
  daemon.start();
  HttpConnection again = watch("/v1/events:watch?topics=job", "Last-Event-ID: " + seen + "\r\n");
  EXPECT_EQ(again.read_event().id, seen);
  EXPECT_EQ(again.read_event().json().at("job").at("event").at("job"), name);
}

TEST_F(HttpEvents, DisconnectFreesTheSlot) {
  for (int round = 0; round < 3; ++round) {
    std::vector<HttpConnection> streams;
    // At most 128 streams may be open, so a hundred need the slots of the hundred before. The
    // server's threads check twice a second for closed streams.
    const auto is_open = [&] {
      HttpConnection& stream = streams.emplace_back(daemon.http());
      stream.send(request_text("GET", "/v1/events:watch?topics=job"));
      if (stream.read_head().status == 200) return true;
      streams.pop_back();
      return false;
    };
    for (int i = 0; i < 100; ++i) {
      ASSERT_TRUE(wait_until(is_open, 60, 0.05)) << "round " << round << ", stream " << i;
      EXPECT_EQ(streams.back().read_event().kind, "begin");
    }
    EXPECT_EQ(get("/v1/queue").status, 200);
    streams.clear();
    const auto has_closed = [&] {
      return get("/metrics").body.find("hydroprint_http_connections 1\n") != std::string::npos;
    };
    EXPECT_TRUE(wait_until(has_closed, 60));
  }
}

TEST_F(HttpEvents, The129thStreamIsRefused) {
  std::vector<HttpConnection> streams;
  for (int i = 0; i < 128; ++i) streams.push_back(watch("/v1/events:watch?topics=job"));
  const HttpAnswer more = get("/v1/events:watch");
  EXPECT_EQ(more.status, 429);
  EXPECT_EQ(more.reason(), "WATCHES_FULL");
  EXPECT_EQ(get("/v1/jobs").status, 200);
}

}  // namespace
}  // namespace hydroprint::tests
