// Many concurrent clients, through the daemon.
#include <atomic>
#include <thread>

#include "tests/daemon/http/http_support.h"

namespace hydroprint::tests {
namespace {

#ifdef __SANITIZE_ADDRESS__
constexpr int kCallsOfEach = 100;
#else
constexpr int kCallsOfEach = 500;
#endif

TEST_F(HttpTest, ThousandsOfCallsGetTheirOwnAnswers) {
  constexpr int kClients = 16;
  std::vector<std::string> jobs;
  for (int i = 0; i < 4; ++i) jobs.push_back(simulate("# " + std::to_string(i)));
  std::vector<HttpConnection> streams;
  for (int i = 0; i < 20; ++i) {
    streams.emplace_back(daemon.http());
    streams.back().send(request_text("GET", "/v1/events:watch?topics=rig"));
  }
  std::atomic<int> good{0};
  std::vector<std::thread> threads;
  for (int i = 0; i < kClients; ++i) {
    threads.emplace_back([&, i] {
      HttpConnection connection(daemon.http());
      for (int call = 0; call < kCallsOfEach; ++call) {
        // Sometimes the connection breaks during a call, and a new one is made.
        if (call % 50 == 49) {
          connection.send(request_text("GET", "/v1/jobs"));
          connection = HttpConnection(daemon.http());
        }
        const std::string& name = jobs[static_cast<std::size_t>(i + call) % jobs.size()];
        const bool is_there = call % 5 != 0;
        const HttpAnswer answer = connection.ask("GET", is_there ? "/v1/" + name : "/v1/jobs/999");
        const bool is_right = is_there ? answer.status == 200 && answer.json().at("name") == name
                                       : answer.reason() == "JOB_NOT_FOUND";
        if (is_right) ++good;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(good, kClients * kCallsOfEach);
}

TEST_F(HttpTest, IdleConnectionsCostLittle) {
  if (!proc_is_mounted()) GTEST_SKIP() << kNeedsProc;
  constexpr std::size_t kIdle = 900;  // one descriptor each; the test may open about 1000
  const HttpAnswer warm = get("/v1/queue");
  const std::size_t before = memory_bytes(daemon.pid());
  std::vector<HttpConnection> idle;
  for (std::size_t i = 0; i < kIdle; ++i) {
    idle.emplace_back(daemon.http());
    if (i % 2 != 0) continue;
    EXPECT_EQ(idle.back().ask("GET", "/v1/queue").body, warm.body);
  }
  EXPECT_EQ(get("/v1/queue").body, warm.body);
  const std::size_t each = (memory_bytes(daemon.pid()) - before) / kIdle;
  RecordProperty("bytes_of_an_idle_connection", std::to_string(each));
  std::cout << "an idle connection costs " << each << " bytes\n";
#ifndef __SANITIZE_ADDRESS__
  EXPECT_LT(each, 20'000U);
#endif
}

}  // namespace
}  // namespace hydroprint::tests
