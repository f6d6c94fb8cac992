// Round trips through the real daemon over gRPC: assets, jobs, queue, artifacts.
#include <grpcpp/generic/generic_stub.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <set>

#include "google/rpc/status.pb.h"
#include "hydroprint/v1/error_reason.pb.h"
#include "tests/daemon/api/support.h"

namespace hydroprint::tests {
namespace {

using grpc::StatusCode;

// Expects an error with this code and reason, and a message of one line.
void expect_refused(const grpc::Status& status, StatusCode code, const std::string& reason) {
  EXPECT_EQ(status.error_code(), code) << status.error_message();
  const auto info = error_info(status);
  EXPECT_EQ(info.reason(), reason);
  EXPECT_EQ(info.domain(), "hydroprint");
  v1::ErrorReason known{};
  EXPECT_TRUE(v1::ErrorReason_Parse(info.reason(), &known)) << info.reason();
  EXPECT_EQ(status.error_message().find('\n'), std::string::npos);
}

class Api : public ::testing::Test {
 protected:
  static DaemonProcess::Options options() {
    DaemonProcess::Options options = DaemonProcess::fake();
    options.max_jobs = 12;
    options.extra = "[assets]\nmax_mib = 2\n";
    return options;
  }
  v1::Job make(const v1::CreateJobRequest& request) {
    v1::Job job;
    const grpc::Status status = client.create(request, job);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return job;
  }

  TemporaryFolder folder;
  DaemonProcess daemon{folder.path(), options()};
  Client client{daemon.address()};
};

TEST_F(Api, UploadCreateWatchDownload) {
  const std::string mesh = "sleep 0.6\n" + std::string(200000, '#');
  const v1::Job job = client.simulate(mesh);
  EXPECT_EQ(job.state(), v1::Job::QUEUED);
  EXPECT_EQ(job.owner(), "anonymous");
  v1::WatchJobRequest request;
  request.set_name(job.name());
  const auto call = client.context();
  const auto reader = client.jobs->WatchJob(call.get(), request);
  std::vector<v1::WatchJobResponse> messages;
  for (v1::WatchJobResponse message; reader->Read(&message);) messages.push_back(message);
  ASSERT_TRUE(reader->Finish().ok());
  ASSERT_GE(messages.size(), 3U);
  EXPECT_TRUE(messages.front().has_job());
  EXPECT_FALSE(messages.front().has_event());
  EXPECT_EQ(messages.back().job().state(), v1::Job::SUCCEEDED);
  EXPECT_EQ(messages.back().job().progress_fraction(), 1);
  bool progressed = false;
  for (std::size_t i = 1; i < messages.size(); ++i) {
    EXPECT_GT(messages[i].seq(), messages[i - 1].seq());
    const auto& event = messages[i].event();
    progressed |= event.kind() == v1::JobEvent::PROGRESS && event.phase() == "velocity";
  }
  EXPECT_TRUE(progressed);

  v1::ListArtifactsRequest list;
  list.set_parent(job.name());
  list.set_page_size(1);
  std::set<std::string> names;
  do {
    v1::ListArtifactsResponse page;
    ASSERT_TRUE(client.artifacts->ListArtifacts(client.context().get(), list, &page).ok());
    ASSERT_EQ(page.artifacts_size(), 1);
    const auto& artifact = page.artifacts(0);
    names.insert(artifact.name());
    const std::string bytes = client.download(artifact.name());
    EXPECT_EQ(static_cast<std::int64_t>(bytes.size()), artifact.size_bytes());
    EXPECT_EQ(hash_of(bytes), artifact.sha256());
    EXPECT_EQ(client.download(artifact.name(), 3), bytes.substr(3));
    list.set_page_token(page.next_page_token());
  } while (!list.page_token().empty());
  EXPECT_EQ(names, (std::set<std::string>{job.name() + "/artifacts/film.png",
                                          job.name() + "/artifacts/report.json"}));
}

TEST_F(Api, WorkerReceivesTheSpec) {
  auto request = simulate_request(client.upload(""), "models/a b.obj");
  auto& spec = *request.mutable_job()->mutable_simulate();
  spec.set_dpi(150);
  spec.set_threads(1);
  for (const double x : {1, 0, 0, 0}) spec.mutable_pose()->add_rotation_wxyz(x);
  for (const double x : {3, 4, 5}) spec.mutable_pose()->add_translation_mm(x);
  const v1::Job job = client.wait_for_end(make(request).name());
  const std::string report = client.download(job.name() + "/artifacts/report.json");
  for (const char* flag : {"simulate ", "--threads=1 ", "--inputs=. "}) {
    EXPECT_NE(report.find(flag), std::string::npos) << report;
  }
  const auto given = given_spec(report);
  EXPECT_EQ(given["mesh"]["name"], "models/a b.obj");
  EXPECT_EQ(given["dpi"], 150);
  EXPECT_EQ(given["pose"]["translationMm"][2], 5);
}

TEST_F(Api, EqualBytesAreUploadedOnce) {
  const std::string name = client.upload("mesh");
  v1::StartUploadRequest request;
  request.set_size_bytes(4);
  request.set_sha256(hash_of("mesh"));
  v1::StartUploadResponse reply;
  ASSERT_TRUE(client.assets->StartUpload(client.context().get(), request, &reply).ok());
  EXPECT_EQ(reply.asset().name(), name);
  EXPECT_EQ(reply.asset().size_bytes(), 4);
}

TEST_F(Api, WrongBytesAreRefusedAndEndTheUpload) {
  v1::StartUploadRequest request;
  request.set_size_bytes(4);
  request.set_sha256(hash_of("mesh"));
  v1::StartUploadResponse started;
  ASSERT_TRUE(client.assets->StartUpload(client.context().get(), request, &started).ok());
  v1::UploadChunkRequest chunk;
  chunk.set_upload(started.upload().name());
  chunk.set_data("mess");
  const auto send = [&] {
    v1::UploadChunkResponse reply;
    const auto call = client.context();
    const auto writer = client.assets->UploadChunk(call.get(), &reply);
    writer->Write(chunk);
    writer->WritesDone();
    return writer->Finish();
  };
  expect_refused(send(), StatusCode::INVALID_ARGUMENT, "ASSET_HASH_MISMATCH");
  expect_refused(send(), StatusCode::NOT_FOUND, "UPLOAD_NOT_FOUND");
}

TEST_F(Api, InvalidUploadsAreRefused) {
  v1::StartUploadRequest request;
  v1::StartUploadResponse reply;
  const auto start = [&] {
    return client.assets->StartUpload(client.context().get(), request, &reply);
  };
  request.set_sha256("../../etc/passwd");
  expect_refused(start(), StatusCode::INVALID_ARGUMENT, "ID_INVALID");
  request.set_sha256(std::string(64, 'a'));
  request.set_size_bytes(3 << 20);
  expect_refused(start(), StatusCode::RESOURCE_EXHAUSTED, "ASSET_TOO_LARGE");
  request.set_size_bytes(-1);
  expect_refused(start(), StatusCode::INVALID_ARGUMENT, "SPEC_INVALID");
}

TEST_F(Api, RepeatedRequestReturnsTheSameJob) {
  auto request = simulate_request(client.upload(""));
  request.set_request_id("4e3c1a52-7f6d-4f4e-9b0e-111111111111");
  (*request.mutable_job()->mutable_labels())["b"] = "2";
  (*request.mutable_job()->mutable_labels())["a"] = "1";
  const std::string name = make(request).name();
  EXPECT_EQ(make(request).name(), name);
  request.mutable_job()->set_priority(3);
  v1::Job job;
  expect_refused(client.create(request, job), StatusCode::INVALID_ARGUMENT, "REQUEST_ID_REUSED");
}

TEST_F(Api, ValidateOnlyStoresNothing) {
  auto request = simulate_request(client.upload("sleep 30"));
  request.set_validate_only(true);
  const v1::Job job = make(request);
  EXPECT_TRUE(job.name().empty());
  EXPECT_EQ(job.input_digest().size(), 64U);
  v1::ListJobsResponse list;
  ASSERT_TRUE(client.jobs->ListJobs(client.context().get(), {}, &list).ok());
  EXPECT_EQ(list.jobs_size(), 0);
  v1::Job none;
  request.mutable_job()->mutable_simulate()->set_dpi(-1);
  expect_refused(client.create(request, none), StatusCode::INVALID_ARGUMENT, "SPEC_INVALID");
  request = simulate_request("assets/" + std::string(64, 'a'));
  request.set_validate_only(true);
  expect_refused(client.create(request, none), StatusCode::FAILED_PRECONDITION, "ASSET_MISSING");
}

// Returns the list of wrong fields in a refusal; an empty one if the refusal has no such list.
google::rpc::BadRequest bad_request(const grpc::Status& status) {
  google::rpc::Status details;
  google::rpc::BadRequest bad;
  EXPECT_TRUE(details.ParseFromString(status.error_details()));
  EXPECT_EQ(details.details_size(), 2);
  EXPECT_TRUE(details.details_size() == 2 && details.details(1).UnpackTo(&bad));
  return bad;
}

std::vector<std::string> fields_of(const google::rpc::BadRequest& bad) {
  std::vector<std::string> fields;
  for (const auto& violation : bad.field_violations()) fields.push_back(violation.field());
  return fields;
}

TEST_F(Api, AllWrongFieldsAreReportedTogether) {
  auto request = simulate_request(client.upload(""));
  request.set_validate_only(true);
  request.mutable_job()->set_priority(10);
  request.mutable_job()->mutable_simulate()->set_film("A9");
  request.mutable_job()->mutable_simulate()->set_threads(0);
  v1::Job none;
  const grpc::Status status = client.create(request, none);
  expect_refused(status, StatusCode::INVALID_ARGUMENT, "SPEC_INVALID");
  const auto bad = bad_request(status);
  ASSERT_EQ(fields_of(bad),
            (std::vector<std::string>{"priority", "simulate.film", "simulate.threads"}));
  EXPECT_EQ(bad.field_violations(2).description(), "must be from 1 to 256");
}

TEST_F(Api, WrongFieldsAreReportedBeforeTheCalibrationIsLookedUp) {
  auto request = simulate_request(client.upload(""));
  auto& spec = *request.mutable_job()->mutable_simulate();
  spec.set_calibration("calibrations/99");
  spec.set_scale(2);
  spec.set_dpi(-1);
  v1::Job none;
  const grpc::Status status = client.create(request, none);
  expect_refused(status, StatusCode::INVALID_ARGUMENT, "SPEC_INVALID");
  const auto fields = fields_of(bad_request(status));
  EXPECT_TRUE(std::count(fields.begin(), fields.end(), "simulate.scale")) << status.error_message();
  EXPECT_TRUE(std::count(fields.begin(), fields.end(), "simulate.dpi")) << status.error_message();
}

TEST_F(Api, HostileNamesAreRefused) {
  const std::string asset = client.upload("");
  v1::Job job;
  for (const char* name : {"../x", "/etc/passwd", "a/../../x", "-x", "a\nb", "a\\b", ""}) {
    expect_refused(client.create(simulate_request(asset, name), job), StatusCode::INVALID_ARGUMENT,
                   "NAME_INVALID");
  }
  v1::GetArtifactRequest artifact;
  artifact.set_name("jobs/1/artifacts/../../../lock");
  v1::Artifact reply;
  expect_refused(client.artifacts->GetArtifact(client.context().get(), artifact, &reply),
                 StatusCode::INVALID_ARGUMENT, "NAME_INVALID");
  v1::GetJobRequest get;
  get.set_name("jobs/../jobs/1");
  expect_refused(client.jobs->GetJob(client.context().get(), get, &job),
                 StatusCode::INVALID_ARGUMENT, "ID_INVALID");
  get.set_name("jobs/1");
  expect_refused(client.jobs->GetJob(client.context().get(), get, &job), StatusCode::NOT_FOUND,
                 "JOB_NOT_FOUND");
  Client other(daemon.address(), "two words");
  expect_refused(other.create(simulate_request(asset), job), StatusCode::INVALID_ARGUMENT,
                 "SPEC_INVALID");
}

TEST_F(Api, ListsArePagedNewestFirst) {
  client.pause();
  std::vector<std::string> names;
  for (int i = 0; i < 5; ++i) names.push_back(client.simulate("#" + std::to_string(i)).name());
  v1::ListJobsRequest request;
  request.set_page_size(2);
  std::vector<std::string> listed;
  int pages = 0;
  do {
    v1::ListJobsResponse page;
    ASSERT_TRUE(client.jobs->ListJobs(client.context().get(), request, &page).ok());
    EXPECT_LE(page.jobs_size(), 2);
    for (const auto& job : page.jobs()) listed.insert(listed.begin(), job.name());
    request.set_page_token(page.next_page_token());
    ++pages;
  } while (!request.page_token().empty());
  EXPECT_EQ(listed, names);
  EXPECT_EQ(pages, 3);
  v1::ListJobsResponse page;
  request.set_page_token("../1");
  expect_refused(client.jobs->ListJobs(client.context().get(), request, &page),
                 StatusCode::INVALID_ARGUMENT, "PAGE_TOKEN_INVALID");
  request.clear_page_token();
  request.set_page_size(-1);
  expect_refused(client.jobs->ListJobs(client.context().get(), request, &page),
                 StatusCode::INVALID_ARGUMENT, "SPEC_INVALID");
}

TEST_F(Api, FullQueueIsRefusedWithARetryDelay) {
  client.pause();
  for (int i = 0; i < 12; ++i) client.simulate("#" + std::to_string(i));
  v1::Job job;
  const grpc::Status status = client.create(simulate_request(client.upload("x")), job);
  expect_refused(status, StatusCode::RESOURCE_EXHAUSTED, "QUEUE_FULL");
  google::rpc::Status details;
  ASSERT_TRUE(details.ParseFromString(status.error_details()));
  ASSERT_EQ(details.details_size(), 2);
  EXPECT_TRUE(details.details(1).Is<google::rpc::RetryInfo>());
}

TEST_F(Api, PausedQueueStartsNothingUntilResumed) {
  client.pause();
  const v1::Job job = client.simulate("");
  EXPECT_TRUE(client.queue().paused());
  EXPECT_EQ(client.queue().pause_reason(), "test");
  EXPECT_EQ(client.queue().queued_jobs(0), job.name());
  EXPECT_EQ(client.job(job.name()).state(), v1::Job::QUEUED);
  client.resume();
  EXPECT_EQ(client.wait_for_end(job.name()).state(), v1::Job::SUCCEEDED);
}

TEST_F(Api, OwnersTakeTurns) {
  client.pause();
  Client ann(daemon.address(), "ann"), bob(daemon.address(), "bob");
  const std::string a1 = ann.simulate("#1").name(), a2 = ann.simulate("#2").name(),
                    b1 = bob.simulate("#3").name();
  const v1::Queue queue = client.queue();
  EXPECT_EQ((std::vector<std::string>{queue.queued_jobs().begin(), queue.queued_jobs().end()}),
            (std::vector<std::string>{a1, b1, a2}));
  v1::MoveJobRequest move;
  move.set_name(a2);
  move.set_before(a1);
  v1::Job moved;
  ASSERT_TRUE(client.queues->MoveJob(client.context().get(), move, &moved).ok());
  EXPECT_EQ(client.queue().queued_jobs(0), a2);
  move.set_before(b1);
  expect_refused(client.queues->MoveJob(client.context().get(), move, &moved),
                 StatusCode::FAILED_PRECONDITION, "STATE_FORBIDS");
}

TEST_F(Api, IdenticalInputsAreVisiblyCached) {
  const v1::Job first = client.wait_for_end(client.simulate("#same").name());
  EXPECT_FALSE(first.cache_hit());
  const v1::Job second = client.simulate("#same");
  EXPECT_EQ(second.state(), v1::Job::SUCCEEDED);
  EXPECT_TRUE(second.cache_hit());
  EXPECT_EQ(second.input_digest(), first.input_digest());
  EXPECT_EQ(client.download(second.name() + "/artifacts/report.json"),
            client.download(first.name() + "/artifacts/report.json"));
}

TEST_F(Api, RetryComputesAgainAndNamesTheFirstJob) {
  const v1::Job first = client.wait_for_end(client.simulate("#x").name());
  v1::RetryJobRequest request;
  request.set_name(first.name());
  request.set_request_id("r1");
  v1::Job retry, again;
  ASSERT_TRUE(client.jobs->RetryJob(client.context().get(), request, &retry).ok());
  ASSERT_TRUE(client.jobs->RetryJob(client.context().get(), request, &again).ok());
  EXPECT_EQ(again.name(), retry.name());
  EXPECT_EQ(retry.retry_of(), first.name());
  const v1::Job ended = client.wait_for_end(retry.name());
  EXPECT_EQ(ended.state(), v1::Job::SUCCEEDED);
  EXPECT_FALSE(ended.cache_hit());
}

TEST_F(Api, DeletingAJobDeletesItsArtifacts) {
  const v1::Job job = client.wait_for_end(client.simulate("").name());
  v1::DeleteJobRequest request;
  request.set_name(job.name());
  google::protobuf::Empty nothing;
  ASSERT_TRUE(client.jobs->DeleteJob(client.context().get(), request, &nothing).ok());
  expect_refused(client.jobs->DeleteJob(client.context().get(), request, &nothing),
                 StatusCode::NOT_FOUND, "JOB_NOT_FOUND");
  EXPECT_TRUE(std::filesystem::is_empty(daemon.state() / "artifacts"));
}

TEST_F(Api, WatchResumesAfterTheLastEvent) {
  const v1::Job job = client.wait_for_end(client.simulate("").name());
  const auto events = client.events(job.name());
  ASSERT_EQ(events.size(), 3U);
  v1::WatchJobRequest request;
  request.set_name(job.name());
  request.set_after_seq(events[0].seq());
  const auto call = client.context();
  const auto reader = client.jobs->WatchJob(call.get(), request);
  v1::WatchJobResponse message;
  ASSERT_TRUE(reader->Read(&message));
  EXPECT_EQ(message.seq(), events[0].seq());
  EXPECT_EQ(message.job().state(), v1::Job::SUCCEEDED);
  ASSERT_TRUE(reader->Read(&message));
  EXPECT_EQ(message.event().state(), v1::Job::RUNNING);
  ASSERT_TRUE(reader->Read(&message));
  EXPECT_EQ(message.event().state(), v1::Job::SUCCEEDED);
  EXPECT_FALSE(reader->Read(&message));
  EXPECT_TRUE(reader->Finish().ok());

  request.set_after_seq(1000000);
  const auto second = client.context();
  const auto refused = client.jobs->WatchJob(second.get(), request);
  EXPECT_FALSE(refused->Read(&message));
  expect_refused(refused->Finish(), StatusCode::OUT_OF_RANGE, "EVENTS_GONE");
}

TEST_F(Api, DownloadsBeyondTheEndOrOfDamagedFilesFail) {
  const v1::Job job = client.wait_for_end(client.simulate("").name());
  v1::DownloadArtifactRequest request;
  request.set_name(job.name() + "/artifacts/film.png");
  const auto end_of = [&] {
    const auto call = client.context();
    const auto reader = client.artifacts->DownloadArtifact(call.get(), request);
    for (v1::DownloadArtifactResponse chunk; reader->Read(&chunk);) {
    }
    return reader->Finish();
  };
  request.set_offset(1000);
  expect_refused(end_of(), StatusCode::OUT_OF_RANGE, "OFFSET_MISMATCH");
  request.set_offset(0);
  std::ofstream(daemon.state() / "artifacts" / "1" / "film.png") << "x";
  expect_refused(end_of(), StatusCode::DATA_LOSS, "ARTIFACT_DAMAGED");
  request.set_name(job.name() + "/artifacts/none.png");
  expect_refused(end_of(), StatusCode::NOT_FOUND, "ARTIFACT_NOT_FOUND");
}

// There is no generated code for health and reflection here, so their messages are written by hand.
std::string call_raw(Client& client, const std::string& method, const std::string& message) {
  grpc::Slice slice(message);
  grpc::ByteBuffer request(&slice, 1), reply;
  grpc::CompletionQueue queue;
  const auto context = client.context();
  grpc::GenericStub stub(client.channel);
  const auto call = stub.PrepareCall(context.get(), method, &queue);
  void* tag = nullptr;
  bool good = false;
  const auto next = [&] { return queue.Next(&tag, &good) && good; };
  call->StartCall(nullptr);
  next();
  call->Write(request, nullptr);
  next();
  call->WritesDone(nullptr);
  next();
  call->Read(&reply, nullptr);
  if (!next()) return "";
  std::vector<grpc::Slice> slices;
  if (!reply.Dump(&slices).ok()) return "";
  std::string out;
  for (const auto& part : slices) {
    out.append(reinterpret_cast<const char*>(part.begin()), part.size());
  }
  grpc::Status status;
  call->Finish(&status, nullptr);
  next();
  return out;
}

TEST_F(Api, HealthAnswersForEveryService) {
  for (const std::string service :
       {"", "hydroprint.v1.JobService", "hydroprint.v1.QueueService", "hydroprint.v1.AssetService",
        "hydroprint.v1.ArtifactService"}) {
    const std::string request =
        service.empty() ? "" : std::string("\x0a") + static_cast<char>(service.size()) + service;
    EXPECT_EQ(call_raw(client, "/grpc.health.v1.Health/Check", request), "\x08\x01") << service;
  }
}

TEST_F(Api, ReflectionListsTheServices) {
  // ServerReflectionRequest.list_services = "*"
  const std::string reply =
      call_raw(client, "/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo",
               std::string("\x3a\x01*"));
  EXPECT_NE(reply.find("hydroprint.v1.JobService"), std::string::npos);
  EXPECT_NE(reply.find("grpc.health.v1.Health"), std::string::npos);
}

TEST_F(Api, SecondDaemonCannotUseThePortOrTheStateFolder) {
  TemporaryFolder other;
  const std::string config = daemon.config().string();
  const Ended port = run_daemon(
      {"--config", config, "--state-dir", other.path().string(), "--grpc", daemon.address()});
  EXPECT_EQ(port.status, 4);
  EXPECT_NE(port.words.find(daemon.address()), std::string::npos) << port.words;
  const Ended http = run_daemon({"--config", config, "--state-dir", other.path().string(), "--grpc",
                                 "127.0.0.1:0", "--http", daemon.http()});
  EXPECT_EQ(http.status, 4);
  EXPECT_NE(http.words.find(daemon.http()), std::string::npos) << http.words;
  EXPECT_NE(http.words.find("--http"), std::string::npos) << http.words;
  const Ended state = run_daemon(
      {"--config", config, "--state-dir", daemon.state().string(), "--grpc", "127.0.0.1:0"});
  EXPECT_EQ(state.status, 4);
  EXPECT_NE(state.words.find(std::to_string(daemon.pid())), std::string::npos) << state.words;
  EXPECT_EQ(client.wait_for_end(client.simulate("").name()).state(), v1::Job::SUCCEEDED);
}

TEST(Program, AddressesBeyondLoopbackAreRefusedWithoutTls) {
  for (const char* address : {"0.0.0.0:0", "[::]:0", "10.0.0.1:0"}) {
    const Ended ended = run_daemon({"--grpc", address});
    EXPECT_EQ(ended.status, 3);
    EXPECT_NE(ended.words.find("loopback"), std::string::npos) << ended.words;
    EXPECT_NE(ended.words.find("--tls-certificate FILE"), std::string::npos) << ended.words;
    const Ended http = run_daemon({"--http", address});
    EXPECT_EQ(http.status, 3);
    EXPECT_NE(http.words.find("loopback"), std::string::npos) << http.words;
  }
}

TEST(Program, ConfigurationCanBeCheckedWithoutStarting) {
  TemporaryFolder folder;
  const auto good = folder.write("good.toml", "[workers]\ncount = 2\n");
  EXPECT_EQ(run_daemon({"--check-config", "--config", good.string()}).status, 0);
  const auto bad = folder.write("bad.toml", "[workers]\ncuont = 2\n");
  const Ended ended = run_daemon({"--check-config", "--config", bad.string()});
  EXPECT_EQ(ended.status, 3);
  EXPECT_NE(ended.words.find("bad.toml:2:"), std::string::npos) << ended.words;
  EXPECT_EQ(run_daemon({"--no-such-flag"}).status, 2);
}

TEST(Program, MissingWorkerProgramIsReportedAtTheStart) {
  TemporaryFolder folder;
  const auto config = folder.write("d.toml", "[workers]\nprogram = \"/nonexistent/worker\"\n");
  const Ended ended = run_daemon({"--config", config.string(), "--state-dir",
                                  (folder.path() / "s").string(), "--grpc", "127.0.0.1:0"});
  EXPECT_EQ(ended.status, 4);
  EXPECT_NE(ended.words.find("/nonexistent/worker"), std::string::npos) << ended.words;
}

}  // namespace
}  // namespace hydroprint::tests
