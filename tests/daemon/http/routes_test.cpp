// The API over HTTP, through the daemon.
#include "tests/daemon/http/http_support.h"

namespace hydroprint::tests {
namespace {

TEST_F(HttpTest, JobRunsOverJson) {
  const std::string name = simulate("sleep 0.1");
  EXPECT_EQ(client.wait_for_end(name).state(), v1::Job::SUCCEEDED);
  const auto job = get("/v1/" + name).json();
  EXPECT_EQ(job.at("state"), "SUCCEEDED");
  EXPECT_EQ(job.at("owner"), "anonymous");
  const auto jobs = get("/v1/jobs?pageSize=1&states=SUCCEEDED").json();
  EXPECT_EQ(jobs.at("jobs").at(0).at("name"), name);
  EXPECT_EQ(ask(daemon.http(), "DELETE", "/v1/" + name).status, 200);
  EXPECT_EQ(get("/v1/" + name).reason(), "JOB_NOT_FOUND");
}

TEST_F(HttpTest, HeaderNamesTheOwner) {
  const std::string asset = upload("");
  const nlohmann::json job = {{"simulate", {{"mesh", {{"name", "m.obj"}, {"asset", asset}}}}}};
  const std::string owner = "Hydroprint-Owner: ann\r\n";
  EXPECT_EQ(ask(daemon.http(), "POST", "/v1/jobs", job.dump(), owner).json().at("owner"), "ann");
  const auto bad =
      ask(daemon.http(), "POST", "/v1/jobs", job.dump(), "Hydroprint-Owner: \xc3\xa9\r\n");
  EXPECT_EQ(bad.status, 400);
  EXPECT_EQ(bad.reason(), "SPEC_INVALID");
}

TEST_F(HttpTest, RequestWithTheSameKeyIsDoneOnce) {
  const std::string asset = upload("");
  const nlohmann::json job = {{"simulate", {{"mesh", {{"name", "m.obj"}, {"asset", asset}}}}}};
  const auto create = [&](const std::string& key, const std::string& query = "") {
    return ask(daemon.http(), "POST", "/v1/jobs" + query, job.dump(),
               "Idempotency-Key: " + key + "\r\n")
        .json()
        .at("name");
  };
  const auto first = create("a");
  EXPECT_EQ(create("a"), first);
  EXPECT_EQ(create("b", "?requestId=a"), first);
  EXPECT_NE(create("b"), first);
}

TEST_F(HttpTest, ErrorsAreGoogleRpcStatus) {
  const HttpAnswer missing = get("/v1/jobs/77");
  EXPECT_EQ(missing.status, 404);
  EXPECT_EQ(missing.field("content-type"), "application/json");
  const auto error = missing.json().at("error");
  EXPECT_EQ(error.at("code"), 404);
  EXPECT_EQ(error.at("status"), "NOT_FOUND");
  EXPECT_EQ(missing.reason(), "JOB_NOT_FOUND");
  EXPECT_EQ(get("/v1/nothing").reason(), "ROUTE_NOT_FOUND");
  EXPECT_EQ(post("/v1/jobs", "{").reason(), "JSON_INVALID");
  EXPECT_EQ(post("/v1/jobs", "{\"simulate\": {}}").status, 400);
  EXPECT_EQ(get("/v1/jobs?pagesize=1").status, 400);
}

TEST_F(HttpTest, ValidateOnlyRefusesAFilmThatTheWorkerWouldRefuse) {
  nlohmann::json job = {{"simulate", {{"mesh", {{"name", "m.obj"}, {"asset", upload("")}}}}}};
  const auto validate = [&] { return post("/v1/jobs?validateOnly=true", job.dump()); };
  job["simulate"]["film"] = "A3";
  EXPECT_EQ(validate().status, 200);
  job["simulate"]["film"] = "A9";
  job["simulate"]["dpi"] = 1;
  const HttpAnswer refused = validate();
  EXPECT_EQ(refused.status, 400);
  EXPECT_EQ(refused.reason(), "SPEC_INVALID");
  const auto details = refused.json().at("error").at("details");
  EXPECT_EQ(details.at(0).at("metadata").at("field"), "simulate.film");
  const auto wrong = details.at(1).at("fieldViolations");
  ASSERT_EQ(wrong.size(), 2U);
  EXPECT_EQ(wrong.at(0).at("field"), "simulate.film");
  EXPECT_EQ(wrong.at(1).at("field"), "simulate.dpi");
  EXPECT_EQ(wrong.at(1).at("description"), "must be from 20 to 2400 dots per inch");
}

TEST_F(HttpTest, WrongMethodIsAnsweredWithAllow) {
  const HttpAnswer wrong = ask(daemon.http(), "PUT", "/v1/jobs/1", "{}");
  EXPECT_EQ(wrong.status, 405);
  EXPECT_EQ(wrong.reason(), "METHOD_NOT_ALLOWED");
  EXPECT_EQ(wrong.field("allow"), "DELETE, GET, HEAD, OPTIONS");
  const HttpAnswer options = ask(daemon.http(), "OPTIONS", "/v1/uploads/3");
  EXPECT_EQ(options.status, 204);
  EXPECT_EQ(options.field("allow"), "GET, HEAD, PATCH, OPTIONS");
  EXPECT_EQ(ask(daemon.http(), "OPTIONS", "/v1/nothing").status, 404);
  EXPECT_EQ(ask(daemon.http(), "POST", "/", "x").status, 405);
}

TEST_F(HttpTest, HeadIsGetWithoutABody) {
  HttpConnection connection(daemon.http());
  const HttpAnswer whole = connection.ask("GET", "/v1/queue");
  const HttpAnswer head = connection.ask("HEAD", "/v1/queue");
  EXPECT_EQ(head.status, 200);
  EXPECT_EQ(head.field("content-length"), std::to_string(whole.body.size()));
  EXPECT_EQ(connection.ask("GET", "/v1/queue").body, whole.body);
  EXPECT_EQ(connection.ask("HEAD", "/v1/events:watch").status, 405);
}

TEST_F(HttpTest, EveryAnswerHasSecurityHeaders) {
  for (const char* target : {"/", "/v1/jobs", "/v1/jobs/77", "/healthz", "/metrics", "/none.js"}) {
    const HttpAnswer answer = get(target);
    EXPECT_EQ(answer.field("x-content-type-options"), "nosniff") << target;
    EXPECT_EQ(answer.field("referrer-policy"), "no-referrer") << target;
    EXPECT_EQ(answer.field("content-security-policy"), "default-src 'self'; frame-ancestors 'none'")
        << target;
    EXPECT_FALSE(answer.fields.contains("access-control-allow-origin")) << target;
    EXPECT_FALSE(answer.field("cache-control").empty()) << target;
  }
  EXPECT_EQ(get("/v1/jobs").field("cache-control"), "no-store");
}

TEST_F(HttpTest, UnknownHostNamesAreRefused) {
  for (const char* host : {"localhost", "LOCALHOST:8080", "127.0.0.1:1", "[::1]:8080", "[::1]"}) {
    HttpConnection connection(daemon.http());
    connection.send("GET /v1/queue HTTP/1.1\r\nHost: " + std::string(host) + "\r\n\r\n");
    EXPECT_EQ(connection.read_answer().status, 200) << host;
  }
  for (const char* host : {"evil.example", "localhost.evil.example", "127.0.0.1.evil.example:80",
                           "", "localhost:x", "[::1", "evil@localhost"}) {
    HttpConnection connection(daemon.http());
    connection.send("GET /v1/queue HTTP/1.1\r\nHost: " + std::string(host) + "\r\n\r\n");
    const HttpAnswer answer = connection.read_answer();
    EXPECT_EQ(answer.status, 421) << host;
    EXPECT_EQ(answer.reason(), "HOST_UNKNOWN") << host;
  }
}

TEST_F(HttpTest, RefusalsOfHostAndOriginNameTheValuesAndTheProxySetting) {
  HttpConnection connection(daemon.http());
  connection.send("GET /v1/queue HTTP/1.1\r\nHost: rig\xc3\xa4.lan\r\n\r\n");
  const std::string host = connection.read_answer().json().at("error").at("message");
  EXPECT_EQ(host.find("unknown host name (Host: rig??.lan)"), 0U) << host;
  EXPECT_NE(host.find("nginx: proxy_set_header Host"), std::string::npos) << host;
  EXPECT_NE(host.find("server.host_names"), std::string::npos) << host;
  const HttpAnswer answer =
      ask(daemon.http(), "POST", "/v1/queue:pause", "{}", "Origin: https://rig.lan\r\n");
  const std::string origin = answer.json().at("error").at("message");
  EXPECT_NE(origin.find("(Origin: https://rig.lan; Host: localhost)"), std::string::npos) << origin;
  EXPECT_NE(origin.find("nginx: proxy_set_header Host"), std::string::npos) << origin;
  EXPECT_NE(origin.find("server.host_names"), std::string::npos) << origin;
}

TEST_F(HttpTest, OtherSitesCannotChangeAnything) {
  const std::string pause = R"({"reason": "evil"})";
  for (const char* origin : {"Origin: http://evil.example\r\n", "Origin: null\r\n",
                             "Origin: http://localhost:1\r\n", "Sec-Fetch-Site: cross-site\r\n"}) {
    const HttpAnswer answer = ask(daemon.http(), "POST", "/v1/queue:pause", pause, origin);
    EXPECT_EQ(answer.status, 403) << origin;
    EXPECT_EQ(answer.reason(), "ORIGIN_FORBIDDEN") << origin;
  }
  EXPECT_FALSE(client.queue().paused());
  const auto own =
      ask(daemon.http(), "POST", "/v1/queue:pause", pause, "Origin: http://localhost\r\n");
  EXPECT_EQ(own.status, 200);
  EXPECT_TRUE(client.queue().paused());
}

TEST_F(HttpTest, HealthReportsEachPart) {
  const HttpAnswer health = get("/healthz");
  EXPECT_EQ(health.status, 200);
  const auto json = health.json();
  EXPECT_EQ(json.at("status"), "ok");
  EXPECT_EQ(json.at("store"), "ok");
  EXPECT_EQ(json.at("rig").at("state"), "OFFLINE");
  EXPECT_EQ(json.at("camera"), "none");
  EXPECT_EQ(json.at("workers").at("slots"), 2);
}

TEST_F(HttpTest, MetricsCoverJobsRigAndServer) {
  EXPECT_EQ(client.wait_for_end(simulate("sleep 0.2")).state(), v1::Job::SUCCEEDED);
  EXPECT_EQ(get("/v1/jobs/99").status, 404);
  std::string text;
  const auto has = [&](const std::string& line) {
    return text.find("\n" + line) != std::string::npos;
  };
  const auto has_come = [&] {  // also waits until earlier connections are closed
    return has("hydroprint_jobs_finished_total{") && has("hydroprint_http_connections 1\n");
  };
  for (int i = 0; i < 1000 && !has_come(); ++i) text = get("/metrics").body;
  EXPECT_TRUE(has("hydroprint_jobs_finished_total{kind=\"simulate\",outcome=\"SUCCEEDED\"} 1\n"));
  EXPECT_TRUE(has("hydroprint_job_stage_seconds_count{kind=\"simulate\",stage=\"velocity\"} 1\n"));
  EXPECT_TRUE(has("hydroprint_queue_depth 0\n"));
  EXPECT_TRUE(has("hydroprint_rig_state{state=\"OFFLINE\"} 1\n"));
  EXPECT_TRUE(has("hydroprint_drive_missed_polls_total 0\n"));
  EXPECT_TRUE(has("hydroprint_drive_late_polls_total 0\n"));
  EXPECT_TRUE(has("hydroprint_drive_damaged_replies_total 0\n"));
  EXPECT_TRUE(has("hydroprint_drive_unanswered_requests_total 0\n"));
  EXPECT_TRUE(has("hydroprint_drive_retried_reads_total 0\n"));
  EXPECT_FALSE(has("hydroprint_drive_reply_seconds")) << "without a drive";
  EXPECT_FALSE(has("hydroprint_rig_thread_scheduling")) << "there is no such thread";
  EXPECT_TRUE(has("hydroprint_rejected_logins_total 0\n"));
  EXPECT_TRUE(has("hydroprint_http_connections 1\n"));
  EXPECT_TRUE(
      has("hydroprint_http_requests_total{code=\"404\",method=\"GET\",route=\"JobService/GetJob\"} "
          "1\n"));
  EXPECT_TRUE(
      has("hydroprint_http_request_duration_seconds_count{route=\"JobService/GetJob\"} 1\n"));
  EXPECT_TRUE(has("hydroprint_job_queue_wait_seconds_count{kind=\"simulate\"} 1\n"));
  EXPECT_EQ(get("/metrics").field("content-type"), "text/plain; version=0.0.4; charset=utf-8");
}

TEST(HttpConfig, HostNamesAndWebFolderAreConfigurable) {
  TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "web");
  folder.write("web/index.html", "the client");
  auto options = DaemonProcess::fake();
  options.extra = "[server]\nhost_names = \"print.lab studio\"\nweb_dir = \"" +
                  (folder.path() / "web").string() + "\"\n";
  const DaemonProcess daemon(folder.path(), options);
  for (const char* host : {"print.lab", "STUDIO:8080", "localhost"}) {
    HttpConnection connection(daemon.http());
    connection.send("GET / HTTP/1.1\r\nHost: " + std::string(host) + "\r\n\r\n");
    EXPECT_EQ(connection.read_answer().body, "the client") << host;
  }
  HttpConnection other(daemon.http());
  other.send("GET / HTTP/1.1\r\nHost: lab\r\n\r\n");
  EXPECT_EQ(other.read_answer().status, 421);
}

TEST_F(HttpTest, OpenApiDocumentIsServed) {
  const auto document = get("/openapi.json").json();
  EXPECT_EQ(document.at("openapi"), "3.0.3");
  EXPECT_TRUE(document.at("paths").contains("/v1/events:watch"));
}

}  // namespace
}  // namespace hydroprint::tests
