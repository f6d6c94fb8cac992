#pragma once

#include <grpcpp/grpcpp.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "google/rpc/error_details.pb.h"
#include "hydroprint/v1/artifact_service.grpc.pb.h"
#include "hydroprint/v1/asset_service.grpc.pb.h"
#include "hydroprint/v1/job_service.grpc.pb.h"
#include "hydroprint/v1/people_service.grpc.pb.h"
#include "hydroprint/v1/queue_service.grpc.pb.h"
#include "tests/support/content.h"
#include "tests/support/failure_note.h"
#include "tests/support/process.h"

namespace hydroprint::tests {

using testing::Clock;
using testing::content;
using testing::seconds_since;
using testing::TemporaryFolder;
using testing::wait_until;

/// Whether /proc is mounted, which is needed to inspect other processes; bare chroots lack it.
[[nodiscard]] bool proc_is_mounted();
/// Message of a test that is skipped because /proc is not mounted.
constexpr const char* kNeedsProc = "/proc is not mounted: the daemon's workers cannot be seen";

/// Whether hydroprint-worker was built; some builds leave it out.
[[nodiscard]] bool real_worker_is_built();
/// Message of a test that is skipped because hydroprint-worker is missing.
constexpr const char* kNeedsRealWorker = "hydroprint-worker is not built";

/// Exit status and output of a daemon.
struct Ended {
  int status = -1;    ///< exit status; -1 if killed
  std::string words;  ///< stdout and stderr together
};

/// Runs hydroprintd with these arguments until it exits. HTTP uses any free port unless the
/// arguments set one.
Ended run_daemon(std::vector<std::string> arguments);

/// Throws an error that names the call, unless it succeeded: what follows would wait in vain for a
/// daemon that has died.
void throw_unless_ok(const grpc::Status& status, const char* call);

/// The spec that daemon_fake_worker received, from its report or its spec.json.
nlohmann::json given_spec(const std::string& report);

/// The error details of a status; the reason is empty if there are none.
google::rpc::ErrorInfo error_info(const grpc::Status& status);

/// SHA-256 of bytes, hex.
std::string hash_of(const std::string& bytes);

/// hydroprintd on a free loopback port, with its state in a folder of the test. A failed test
/// prints the end of its log.
class DaemonProcess {
 public:
  struct Options {
    std::filesystem::path worker;  ///< empty: the real worker
    int slots = 2;
    int memory_mib = 0;
    int time_limit_s = 600;
    int file_mib = 1024;
    int max_jobs = 1000;
    int max_jobs_per_owner = 200;
    std::string host = "127.0.0.1";      ///< host of both servers
    std::string workers;                 ///< further lines of the section [workers]
    std::string extra;                   ///< further lines of the configuration file
    std::vector<std::string> arguments;  ///< further arguments
  };
  /// Options with the fake worker.
  static Options fake();

  DaemonProcess(const std::filesystem::path& folder, Options options);
  ~DaemonProcess();
  DaemonProcess(const DaemonProcess&) = delete;
  DaemonProcess& operator=(const DaemonProcess&) = delete;

  void start();
  /// Kills the daemon (SIGKILL). Its workers must end, too.
  void kill();
  /// Sends SIGTERM; returns the exit status.
  int terminate();
  [[nodiscard]] pid_t pid() const { return process_->pid(); }
  [[nodiscard]] const std::string& address() const { return address_; }
  /// Address of the HTTP server: "127.0.0.1:40123".
  [[nodiscard]] const std::string& http() const { return http_; }
  [[nodiscard]] std::filesystem::path state() const { return folder_ / "state"; }
  [[nodiscard]] std::filesystem::path config() const { return folder_ / "hydroprintd.toml"; }
  /// The daemon's log.
  [[nodiscard]] std::string log() const;
  /// Everything on stdout since the last start.
  [[nodiscard]] std::string printed() const { return process_->out(); }
  /// Running processes that the daemon started. Needs /proc.
  [[nodiscard]] std::vector<pid_t> workers() const;

 private:
  [[nodiscard]] std::string end_of_log() const;

  std::filesystem::path folder_;
  Options options_;
  std::optional<testing::Process> process_;
  std::string address_, http_;
  testing::FailureNote note_{[this] { return end_of_log(); }};
};

/// Calls to a daemon. Calls that are expected to succeed throw on failure.
class Client {
 public:
  /// @param ca_pem  the authority to trust; empty: no TLS
  explicit Client(const std::string& address, const std::string& owner = "",
                  const std::string& ca_pem = "");

  /// Uploads an asset unless the daemon has it; returns "assets/{sha256}".
  std::string upload(const std::string& bytes);
  /// Creates a job whose mesh has this content.
  v1::Job simulate(const std::string& mesh);
  grpc::Status create(const v1::CreateJobRequest& request, v1::Job& job);
  v1::Job job(const std::string& name);
  v1::Job cancel(const std::string& name);
  /// Waits until `until` is true for the job and returns the job. Throws after two minutes.
  v1::Job wait(const std::string& name, const std::function<bool(const v1::Job&)>& until);
  v1::Job wait_for(const std::string& name, v1::Job::State state);
  v1::Job wait_for_end(const std::string& name);
  std::vector<v1::JobEvent> events(const std::string& name);
  std::string download(const std::string& artifact, std::int64_t offset = 0);
  v1::Queue queue();
  void pause();
  void resume();

  /// Metadata and deadline of one call.
  [[nodiscard]] std::unique_ptr<grpc::ClientContext> context() const;

  std::string key;      ///< API key for calls; empty: none
  std::string session;  ///< session token for calls; empty: none
  bool patient = true;  ///< whether calls wait for a daemon that is not running
  std::shared_ptr<grpc::Channel> channel;
  std::unique_ptr<v1::JobService::Stub> jobs;
  std::unique_ptr<v1::QueueService::Stub> queues;
  std::unique_ptr<v1::AssetService::Stub> assets;
  std::unique_ptr<v1::ArtifactService::Stub> artifacts;
  std::unique_ptr<v1::PeopleService::Stub> people;

 private:
  std::string owner_;
};

/// An OBJ file of a coloured ball.
std::string ball_obj(double radius_mm = 20);

/// A request for a job whose mesh is this asset.
v1::CreateJobRequest simulate_request(const std::string& asset, const std::string& name = "m.obj");

/// Whether a job is finished.
bool finished(const v1::Job& job);

}  // namespace hydroprint::tests
