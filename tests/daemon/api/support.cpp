#include "tests/daemon/api/support.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <stdexcept>

#include "google/rpc/status.pb.h"
#include "sim/base/sha256.h"
#include "tests/support/paths.h"

namespace hydroprint::tests {
namespace {

constexpr int kPatience_s = 120;  // a real computation may take a minute on a busy machine

// Returns what ThreadSanitizer reported about a process. Its file is named by TSAN_OPTIONS.
std::string race_report(pid_t pid) {
  const char* const set = std::getenv("TSAN_OPTIONS");
  const std::string options = set == nullptr ? "" : set, key = "log_path=";
  const std::size_t at = options.find(key);
  if (at == std::string::npos) return "";
  const std::size_t from = at + key.size();
  return content(options.substr(from, options.find(' ', from) - from) + "." + std::to_string(pid));
}

std::vector<std::string> command(std::vector<std::string> arguments) {
  // The leak checker needs ptrace, which workers may not use.
  ::setenv("ASAN_OPTIONS", "detect_leaks=0", 0);
  arguments.insert(arguments.begin(), testing::program_path("hydroprintd"));
  return arguments;
}

}  // namespace

void throw_unless_ok(const grpc::Status& status, const char* call) {
  if (status.ok()) return;
  throw std::runtime_error(std::string(call) + ": " + std::to_string(status.error_code()) + " " +
                           status.error_message());
}

bool proc_is_mounted() { return std::filesystem::exists("/proc/self/task"); }

bool real_worker_is_built() {
  return std::filesystem::exists(testing::program_path("hydroprint-worker"));
}

Ended run_daemon(std::vector<std::string> arguments) {
  if (std::find(arguments.begin(), arguments.end(), "--http") == arguments.end()) {
    arguments.insert(arguments.end(), {"--http", "127.0.0.1:0"});
  }
  const testing::Ended ended = testing::run(command(arguments));
  return {ended.status, ended.out + ended.err};
}

nlohmann::json given_spec(const std::string& report) {
  const auto json = nlohmann::json::parse(report);
  const nlohmann::json::json_pointer spec("/run/inputs/0/path");
  return json.contains(spec) ? nlohmann::json::parse(json[spec].get<std::string>()) : json;
}

google::rpc::ErrorInfo error_info(const grpc::Status& status) {
  google::rpc::Status details;
  google::rpc::ErrorInfo info;
  if (!details.ParseFromString(status.error_details())) return info;
  for (const auto& detail : details.details()) {
    if (detail.Is<google::rpc::ErrorInfo>()) detail.UnpackTo(&info);
  }
  return info;
}

std::string hash_of(const std::string& bytes) { return sha256(bytes); }

DaemonProcess::Options DaemonProcess::fake() {
  Options options;
  options.worker = testing::program_path("daemon_fake_worker");
  return options;
}

DaemonProcess::DaemonProcess(const std::filesystem::path& folder, Options options)
    : folder_(folder), options_(std::move(options)) {
  std::ofstream file(config());
  file << "[workers]\nprogram = \"" << options_.worker.string() << "\"\ncount = " << options_.slots
       << "\nmemory_mib = " << options_.memory_mib << "\ntime_limit_s = " << options_.time_limit_s
       << "\nfile_mib = " << options_.file_mib << "\nallow_without_landlock = true\n"
       << options_.workers << "\n[queue]\nmax_jobs = " << options_.max_jobs
       << "\nmax_jobs_per_owner = " << options_.max_jobs_per_owner
       << "\n[store]\nmin_free_mib = 1\n"
       << options_.extra;
  file.close();
  start();
}

DaemonProcess::~DaemonProcess() {
  const bool has_ended = process_ && !process_->running();
  if (has_ended) {
    std::cerr << "hydroprintd ended with status " << process_->wait().status << '\n'
              << race_report(pid());
  }
  process_.reset();
  if (has_ended) std::cerr << end_of_log();
}

void DaemonProcess::start() {
  std::vector<std::string> arguments = options_.arguments;
  arguments.insert(arguments.end(),
                   {"--config", config().string(), "--state-dir", state().string(), "--grpc",
                    options_.host + ":0", "--http", options_.host + ":0"});
  testing::ProcessOptions options;
  options.files = {{STDERR_FILENO, folder_ / "err"}};
  process_.emplace(command(arguments), options);
  const auto named = [](const std::string& words, const std::string& name) {
    const std::size_t from = words.find(" " + name + "=") + name.size() + 2;
    return words.substr(from, words.find(' ', from) - from);
  };
  std::string words;
  const auto is_ready = [&] {
    words = process_->out();
    return words.find(" ready ") != std::string::npos && words.ends_with('\n');
  };
  if (!wait_until(is_ready, kPatience_s)) {
    throw std::runtime_error("hydroprintd did not become ready: " + log());
  }
  address_ = named(words, "grpc");
  http_ = named(words, "http");
}

void DaemonProcess::kill() { process_.reset(); }

int DaemonProcess::terminate() {
  process_->signal(SIGTERM);
  return process_->wait().status;
}

std::string DaemonProcess::log() const { return content(folder_ / "err"); }

std::string DaemonProcess::end_of_log() const {
  return "hydroprintd's log ends with:\n" + testing::last_lines(log(), 40);
}

std::vector<pid_t> DaemonProcess::workers() const {
  std::vector<pid_t> out;
  for (const auto& entry :
       std::filesystem::directory_iterator("/proc/" + std::to_string(pid()) + "/task")) {
    std::ifstream children(entry.path() / "children");
    for (pid_t child = 0; children >> child;) out.push_back(child);
  }
  return out;
}

Client::Client(const std::string& address, const std::string& owner, const std::string& ca_pem)
    : owner_(owner) {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  const auto credentials =
      ca_pem.empty() ? grpc::InsecureChannelCredentials() : grpc::SslCredentials({ca_pem, "", ""});
  channel = grpc::CreateCustomChannel(address, credentials, arguments);
  jobs = v1::JobService::NewStub(channel);
  queues = v1::QueueService::NewStub(channel);
  assets = v1::AssetService::NewStub(channel);
  artifacts = v1::ArtifactService::NewStub(channel);
  people = v1::PeopleService::NewStub(channel);
}

std::unique_ptr<grpc::ClientContext> Client::context() const {
  auto context = std::make_unique<grpc::ClientContext>();
  context->set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(kPatience_s));
  context->set_wait_for_ready(patient);
  if (!owner_.empty()) context->AddMetadata("hydroprint-owner", owner_);
  if (!key.empty()) context->AddMetadata("authorization", "Bearer " + key);
  if (!session.empty()) context->AddMetadata("hydroprint-session", session);
  return context;
}

std::string Client::upload(const std::string& bytes) {
  v1::StartUploadRequest request;
  request.set_size_bytes(static_cast<std::int64_t>(bytes.size()));
  request.set_sha256(hash_of(bytes));
  v1::StartUploadResponse started;
  throw_unless_ok(assets->StartUpload(context().get(), request, &started), "StartUpload");
  if (started.has_asset()) return started.asset().name();
  v1::UploadChunkResponse reply;
  const auto call = context();
  const auto writer = assets->UploadChunk(call.get(), &reply);
  std::size_t offset = 0;
  do {
    v1::UploadChunkRequest chunk;
    if (offset == 0) chunk.set_upload(started.upload().name());
    chunk.set_offset(static_cast<std::int64_t>(offset));
    chunk.set_data(bytes.substr(offset, 65536));
    offset += chunk.data().size();
    if (!writer->Write(chunk)) break;
  } while (offset < bytes.size());
  writer->WritesDone();
  throw_unless_ok(writer->Finish(), "UploadChunk");
  return reply.asset().name();
}

grpc::Status Client::create(const v1::CreateJobRequest& request, v1::Job& job) {
  return jobs->CreateJob(context().get(), request, &job);
}

v1::Job Client::simulate(const std::string& mesh) {
  v1::Job job;
  throw_unless_ok(create(simulate_request(upload(mesh)), job), "CreateJob");
  return job;
}

v1::Job Client::job(const std::string& name) {
  v1::GetJobRequest request;
  request.set_name(name);
  v1::Job job;
  throw_unless_ok(jobs->GetJob(context().get(), request, &job), "GetJob");
  return job;
}

v1::Job Client::cancel(const std::string& name) {
  v1::CancelJobRequest request;
  request.set_name(name);
  v1::Job job;
  throw_unless_ok(jobs->CancelJob(context().get(), request, &job), "CancelJob");
  return job;
}

v1::Job Client::wait(const std::string& name, const std::function<bool(const v1::Job&)>& until) {
  v1::Job now;
  const auto is_so = [&] {
    now = job(name);
    return until(now);
  };
  if (!wait_until(is_so, kPatience_s, 0.02)) {
    throw std::runtime_error("the job did not reach the expected state within two minutes: " +
                             now.ShortDebugString());
  }
  return now;
}

v1::Job Client::wait_for(const std::string& name, v1::Job::State state) {
  return wait(name, [&](const v1::Job& job) { return job.state() == state; });
}

v1::Job Client::wait_for_end(const std::string& name) { return wait(name, finished); }

std::vector<v1::JobEvent> Client::events(const std::string& name) {
  v1::ListJobEventsRequest request;
  request.set_parent(name);
  request.set_page_size(1000);
  v1::ListJobEventsResponse reply;
  throw_unless_ok(jobs->ListJobEvents(context().get(), request, &reply), "ListJobEvents");
  return {reply.events().begin(), reply.events().end()};
}

std::string Client::download(const std::string& artifact, std::int64_t offset) {
  v1::DownloadArtifactRequest request;
  request.set_name(artifact);
  request.set_offset(offset);
  const auto call = context();
  const auto reader = artifacts->DownloadArtifact(call.get(), request);
  std::string bytes;
  for (v1::DownloadArtifactResponse chunk; reader->Read(&chunk);) {
    EXPECT_LE(chunk.data().size(), 65536U);
    EXPECT_EQ(chunk.offset(), offset + static_cast<std::int64_t>(bytes.size()));
    bytes += chunk.data();
  }
  throw_unless_ok(reader->Finish(), "DownloadArtifact");
  return bytes;
}

v1::Queue Client::queue() {
  v1::Queue queue;
  throw_unless_ok(queues->GetQueue(context().get(), {}, &queue), "GetQueue");
  return queue;
}

void Client::pause() {
  v1::PauseQueueRequest request;
  request.set_reason("test");
  v1::Queue queue;
  throw_unless_ok(queues->PauseQueue(context().get(), request, &queue), "PauseQueue");
}

void Client::resume() {
  v1::Queue queue;
  throw_unless_ok(queues->ResumeQueue(context().get(), {}, &queue), "ResumeQueue");
}

std::string ball_obj(double radius_mm) {
  constexpr int kRings = 16, kSectors = 32;
  std::ostringstream obj;
  for (int i = 0; i <= kRings; ++i) {
    for (int j = 0; j < kSectors; ++j) {
      const double polar = M_PI * i / kRings, turn = 2 * M_PI * j / kSectors;
      obj << "v " << radius_mm * std::sin(polar) * std::cos(turn) << ' '
          << radius_mm * std::sin(polar) * std::sin(turn) << ' ' << radius_mm * std::cos(polar)
          << " 0.8 0.3 0.1\n";
    }
  }
  const auto vertex = [](int i, int j) { return i * kSectors + j % kSectors + 1; };
  for (int i = 0; i < kRings; ++i) {
    for (int j = 0; j < kSectors; ++j) {
      if (i > 0) {
        obj << "f " << vertex(i, j) << ' ' << vertex(i + 1, j) << ' ' << vertex(i, j + 1) << '\n';
      }
      if (i + 1 < kRings) {
        obj << "f " << vertex(i, j + 1) << ' ' << vertex(i + 1, j) << ' ' << vertex(i + 1, j + 1)
            << '\n';
      }
    }
  }
  return obj.str();
}

v1::CreateJobRequest simulate_request(const std::string& asset, const std::string& name) {
  v1::CreateJobRequest request;
  auto& mesh = *request.mutable_job()->mutable_simulate()->mutable_mesh();
  mesh.set_name(name);
  mesh.set_asset(asset);
  return request;
}

bool finished(const v1::Job& job) {
  return job.state() == v1::Job::SUCCEEDED || job.state() == v1::Job::FAILED ||
         job.state() == v1::Job::CANCELLED ||
         ((job.has_dip() || job.has_print() || job.has_capture()) &&
          job.state() == v1::Job::INTERRUPTED);
}

}  // namespace hydroprint::tests
