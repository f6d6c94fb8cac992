#pragma once

#include <grpcpp/grpcpp.h>
#include <sys/types.h>

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
#include "tests/support/temporary_folder.h"

namespace hydroprint::tests {

/// All of a file; nothing where there is none.
[[nodiscard]] std::string content(const std::filesystem::path& path);

using hydroprint::testing::TemporaryFolder;

/// Whether /proc is mounted, where alone other processes can be looked at; bare chroots have none.
[[nodiscard]] bool proc_is_mounted();
/// Why a test is skipped without.
constexpr const char* kNeedsProc = "/proc is not mounted: the daemon's workers cannot be seen";

/// Whether hydroprint-worker was built, which not every build has.
[[nodiscard]] bool real_worker_is_built();
/// Why a test is skipped without.
constexpr const char* kNeedsRealWorker = "hydroprint-worker is not built";

/// How a program ended and what it said.
struct Ended {
  int status = -1;    ///< exit status; -signal if killed
  std::string words;  ///< stdout and stderr
};

/// Runs hydroprintd with these arguments until it ends by itself; HTTP at any port unless they say.
Ended run_daemon(std::vector<std::string> arguments);

/// The spec that daemon_fake_worker was given: the end of the report that it leaves, or its
/// spec.json.
nlohmann::json given_spec(const std::string& report);

/// What a reply's status says in its details; empty reason if it has none.
google::rpc::ErrorInfo error_info(const grpc::Status& status);

/// SHA-256 of bytes, hex.
std::string hash_of(const std::string& bytes);

/// hydroprintd on a free loopback port, with its state in a folder of the test's.
class DaemonProcess {
 public:
  struct Options {
    std::filesystem::path worker;  ///< empty: the real one
    int slots = 2;
    int memory_mib = 0;
    int time_limit_s = 600;
    int file_mib = 1024;
    int max_jobs = 1000;
    int max_jobs_per_owner = 200;
    std::string host = "127.0.0.1";      ///< where both doors are
    std::string extra;                   ///< more lines for the configuration file
    std::vector<std::string> arguments;  ///< more of the command line
  };
  /// With the fake worker.
  static Options fake();

  DaemonProcess(const std::filesystem::path& folder, Options options);
  ~DaemonProcess();
  DaemonProcess(const DaemonProcess&) = delete;
  DaemonProcess& operator=(const DaemonProcess&) = delete;

  void start();
  /// kill -9; its workers must follow by themselves.
  void kill();
  /// SIGTERM; exit status.
  int terminate();
  [[nodiscard]] pid_t pid() const { return pid_; }
  [[nodiscard]] const std::string& address() const { return address_; }
  /// Where HTTP listens: "127.0.0.1:40123".
  [[nodiscard]] const std::string& http() const { return http_; }
  [[nodiscard]] std::filesystem::path state() const { return folder_ / "state"; }
  [[nodiscard]] std::filesystem::path config() const { return folder_ / "hydroprintd.toml"; }
  /// What it logged.
  [[nodiscard]] std::string log() const;
  /// Processes that the daemon started and that are alive. Needs /proc.
  [[nodiscard]] std::vector<pid_t> workers() const;

 private:
  std::filesystem::path folder_;
  Options options_;
  pid_t pid_ = -1;
  std::string address_, http_;
};

/// Calls to a daemon. What is not expected to fail throws if it does.
class Client {
 public:
  /// @param ca_pem  the authority to trust; empty: TLS is not spoken
  explicit Client(const std::string& address, const std::string& owner = "",
                  const std::string& ca_pem = "");

  /// Uploads unless it is there; "assets/{sha256}".
  std::string upload(const std::string& bytes);
  /// A job whose mesh has this content.
  v1::Job simulate(const std::string& mesh);
  grpc::Status create(const v1::CreateJobRequest& request, v1::Job& job);
  v1::Job job(const std::string& name);
  v1::Job cancel(const std::string& name);
  /// Waits until the predicate holds or two minutes are over.
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

  std::string key;      ///< API key that calls carry; empty: none
  std::string session;  ///< session's token that calls carry; empty: none
  bool patient = true;  ///< whether calls wait for a daemon that is not there
  std::shared_ptr<grpc::Channel> channel;
  std::unique_ptr<v1::JobService::Stub> jobs;
  std::unique_ptr<v1::QueueService::Stub> queues;
  std::unique_ptr<v1::AssetService::Stub> assets;
  std::unique_ptr<v1::ArtifactService::Stub> artifacts;
  std::unique_ptr<v1::PeopleService::Stub> people;

 private:
  std::string owner_;
};

/// A request for a job whose mesh is this asset.
v1::CreateJobRequest simulate_request(const std::string& asset, const std::string& name = "m.obj");

/// True once a job is finished.
bool finished(const v1::Job& job);

}  // namespace hydroprint::tests
