// Limits on clients: the HTTP server with short timeouts and small sizes, connected to a daemon.
#include <chrono>

#include "tests/daemon/http/http_support.h"

namespace hydroprint::tests {
namespace {

using http::Limits;
using std::chrono::milliseconds;

constexpr milliseconds kShort{200};
constexpr double kPatience_s = 120;

/// Whether the server has no other connection.
bool is_alone(HttpConnection& connection) {
  return connection.ask("GET", "/metrics").body.find("http_connections 1\n") != std::string::npos;
}

INSTANTIATE_TEST_SUITE_P(Over, HttpLimits, ::testing::Bool(),
                         [](const auto& test) { return test.param ? "Tls" : "Tcp"; });

TEST_P(HttpLimits, SilentClientIsDisconnected) {
  Limits impatient_at_first;
  impatient_at_first.header_time = kShort;
  serve(impatient_at_first);
  EXPECT_TRUE(connect().is_ended());
  Limits impatient_when_idle;  // with time for the first request, also on a busy machine
  impatient_when_idle.idle_time = kShort;
  serve(impatient_when_idle);
  HttpConnection idle = connect();
  EXPECT_EQ(idle.ask("GET", "/v1/queue").status, 200);
  EXPECT_TRUE(idle.is_ended());
}

TEST_P(HttpLimits, IncompleteHeaderTimesOut) {
  Limits limits;
  limits.header_time = kShort;
  serve(limits);
  HttpConnection slow = connect();
  slow.send("GET / HTTP/1.1\r\nHost: ");
  const HttpAnswer answer = slow.read_answer();
  EXPECT_EQ(answer.status, 408);
  EXPECT_EQ(answer.reason(), "REQUEST_TIMED_OUT");
  EXPECT_TRUE(slow.is_ended());
}

TEST_P(HttpLimits, MissingBodyTimesOut) {
  Limits limits;
  limits.body_time = kShort;
  serve(limits);
  HttpConnection slow = connect();
  slow.send("POST /v1/jobs HTTP/1.1\r\nHost: localhost\r\nContent-Length: 10\r\n\r\n{");
  EXPECT_EQ(slow.read_answer().status, 408);
  EXPECT_TRUE(slow.is_ended());
}

TEST_P(HttpLimits, ConnectionsAreLimited) {
  Limits limits;
  limits.connections = 3;
  serve(limits);
  std::vector<HttpConnection> open;
  for (int i = 0; i < 3; ++i) {
    open.push_back(connect());
    EXPECT_EQ(open.back().ask("GET", "/v1/queue").status, 200);
  }
  HttpConnection more = connect();
  more.send(request_text("GET", "/v1/queue"));
  const HttpAnswer refused = more.read_answer();
  EXPECT_EQ(refused.status, 503);
  EXPECT_EQ(refused.reason(), "CONNECTIONS_FULL");
  EXPECT_EQ(refused.field("retry-after"), "5");
  EXPECT_TRUE(more.is_ended());
  open.pop_back();
  more.close();
  const auto is_served = [&] { return connect().ask("GET", "/v1/queue").status == 200; };
  EXPECT_TRUE(wait_until(is_served, kPatience_s));
}

TEST_P(HttpLimits, QuietStreamSendsPings) {
  Limits limits;
  limits.ping_time = milliseconds(50);
  serve(limits);
  HttpConnection stream = connect();
  stream.send(request_text("GET", "/v1/events:watch?topics=job"));
  stream.read_head();
  EXPECT_EQ(stream.read_event().kind, "begin");
  for (int i = 0; i < 3; ++i) EXPECT_EQ(stream.read_event().kind, "");
}

TEST_P(HttpLimits, ClientThatDoesNotReadIsDisconnectedAndMayReturn) {
  Limits limits;
  limits.write_time = milliseconds(500);
  serve(limits);
  client.wait_for_end(simulate(""));
  HttpConnection stream = connect(4096);
  stream.send(request_text("GET", "/v1/events:watch?topics=job"));
  stream.read_head();
  const HttpEvent begin = stream.read_event();
  // Creates events with much data: jobs with long labels, which finish at once because their
  // results are cached.
  nlohmann::json job = {{"simulate", {{"mesh", {{"name", "m.obj"}, {"asset", upload("")}}}}}};
  for (int i = 0; i < 32; ++i) job["labels"][std::to_string(i)] = std::string(200, 'x');
  HttpConnection other = connect();
  const auto is_let_go = [&] {
    const int status = other.ask("POST", "/v1/jobs", job.dump()).status;
    EXPECT_EQ(status, 200);
    return status != 200 || is_alone(other);
  };
  EXPECT_TRUE(wait_until(is_let_go, kPatience_s, 0));
  HttpConnection back = connect();
  back.send(request_text("GET", "/v1/events:watch?topics=job", "",
                         "Last-Event-ID: " + begin.id + "\r\n"));
  EXPECT_EQ(back.read_head().status, 200);
  EXPECT_EQ(back.read_event().id, begin.id);
  EXPECT_EQ(back.read_event().kind, "job");
}

// The call would otherwise last as long as the job, which is longer than the test's patience.
TEST_P(HttpLimits, DisconnectCancelsTheCall) {
  serve({});
  const std::string name = simulate("sleep 600");
  {
    HttpConnection stream = connect();
    stream.send(request_text("GET", "/v1/" + name + ":watch"));
    stream.read_head();
    stream.read_event();
  }
  HttpConnection connection = connect();
  EXPECT_TRUE(wait_until([&] { return is_alone(connection); }, kPatience_s));
}

TEST_P(HttpLimits, ServerStopsWithOpenConnections) {
  EXPECT_TRUE(stops_at_once([this] {
    std::vector<HttpConnection> open;
    for (int i = 0; i < 30; ++i) open.push_back(connect());
    for (int i = 0; i < 10; ++i) {
      open[i].send(request_text("GET", "/v1/events:watch"));
      open[i].read_head();
      open[10 + i].send("POST /v1/jobs HTTP/1.1\r\nHost: localhost\r\nContent-Length: 10\r\n\r\n{");
    }
    return open;
  }));
}

TEST_P(HttpLimits, MissingServiceIsReported) {
  serve({});
  HttpConnection connection = connect();
  EXPECT_EQ(connection.ask("GET", "/v1/queue").status, 200);
  EXPECT_EQ(daemon.terminate(), 0);
  const HttpAnswer answer = connection.ask("GET", "/v1/queue");
  EXPECT_EQ(answer.status, 503);
  EXPECT_EQ(answer.json().at("error").at("status"), "UNAVAILABLE");
}

}  // namespace
}  // namespace hydroprint::tests
