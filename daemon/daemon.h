#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>

#include "daemon/api/grpc_server.h"
#include "daemon/auth/audit_log.h"
#include "daemon/auth/authenticator.h"
#include "daemon/auth/external_changes.h"
#include "daemon/camera/capture_executor.h"
#include "daemon/camera/live_camera.h"
#include "daemon/config/config.h"
#include "daemon/dip/executor.h"
#include "daemon/http/server.h"
#include "daemon/metrics/job_metrics.h"
#include "daemon/printing/executor.h"
#include "daemon/rig/lease_manager.h"
#include "daemon/rig/rig_gateway.h"
#include "daemon/rig/rig_monitor.h"
#include "daemon/rig/rig_reference.h"
#include "daemon/store/assets/asset_retention.h"
#include "daemon/store/assets/uploads.h"
#include "daemon/store/calibration_store.h"
#include "daemon/store/database/database.h"
#include "daemon/store/device_jobs.h"
#include "daemon/store/job_queue.h"
#include "daemon/store/job_retention.h"
#include "daemon/store/job_store.h"
#include "daemon/store/state_lock.h"
#include "daemon/tls/certificate_reloader.h"
#include "daemon/workers/local_executor.h"
#include "daemon/workers/preview_pool.h"
#include "daemon/workers/worker_pool.h"

namespace hydroprint::daemon {

/// All parts of a running daemon, from the lock on its state folder to the servers.
class Daemon {
 public:
  /// Locks the state folder, repairs the store after a crash, starts listening and starts workers.
  /// Executions that the executor still has go on; other computed jobs that were interrupted are
  /// queued again.
  /// @param first_admin  name of a user, who is created if necessary and gets a link that signs
  ///                     them in once as admin, within 15 minutes; empty: no link
  /// @return for `first_admin`: ID_INVALID; kFailedPrecondition, STATE_FORBIDS if the user exists
  ///         and is not an active admin
  [[nodiscard]] static Result<std::unique_ptr<Daemon>> start(const Config& config,
                                                             const std::string& first_admin);
  /// Calls stop() if needed.
  ~Daemon();
  Daemon(const Daemon&) = delete;
  Daemon& operator=(const Daemon&) = delete;

  [[nodiscard]] const Endpoint& endpoint() const { return server_->endpoint(); }
  [[nodiscard]] const Endpoint& http_endpoint() const { return http_endpoint_; }
  [[nodiscard]] const Layout& layout() const { return layout_; }

  /// Returns the sign-in link for the first admin; empty if none was requested.
  [[nodiscard]] std::string sign_in_link() const;
  /// Returns the address of the web pages, with a host name from the certificate:
  /// "https://rig.example.org:8443/".
  [[nodiscard]] std::string page_address() const;
  /// Returns the number of iterations of the loop that monitors the drive; nullopt if no drive is
  /// configured.
  [[nodiscard]] std::optional<std::uint64_t> control_rounds() const;

  /// Deletes expired data. Must be called regularly.
  void clean_up();
  /// Rejects new calls, ends the workers that do not outlive the daemon, and queues their jobs for
  /// the next start. Takes a few seconds at most.
  void stop();

 private:
  Daemon() = default;
  [[nodiscard]] Status open_store(const Config& config);
  [[nodiscard]] Status repair_store();
  [[nodiscard]] Status interrupt_jobs();
  [[nodiscard]] Status open_people(const Config& config);
  [[nodiscard]] Status open_certificate(const Config& config);
  [[nodiscard]] Status make_first_admin(const std::string& name);
  [[nodiscard]] tls::CurrentIdentity identity() const;
  [[nodiscard]] Status open_rig(const Config& config);
  [[nodiscard]] Status open_printer(const Config& config);
  [[nodiscard]] Status open_camera(const Config& config);
  [[nodiscard]] Status start_serving(const Config& config);
  [[nodiscard]] Status start_http(const Config& config, const ServiceContext& backend);
  [[nodiscard]] Executors executors() const;

  Layout layout_;
  UniqueFd lock_;
  std::unique_ptr<Database> database_;
  std::unique_ptr<auth::Accounts> accounts_;
  std::unique_ptr<auth::AuditLog> audit_;
  std::unique_ptr<Authenticator> access_;
  std::unique_ptr<auth::ExternalChanges> outside_;
  std::unique_ptr<JobChanges> job_changes_;
  std::unique_ptr<JobStore> jobs_;
  std::unique_ptr<JobQueue> queue_;
  std::unique_ptr<DeviceJobs> device_jobs_;
  std::unique_ptr<JobRetention> job_retention_;
  std::unique_ptr<AssetStore> assets_;
  std::unique_ptr<Uploads> uploads_;
  std::unique_ptr<AssetRetention> asset_retention_;
  std::unique_ptr<CalibrationStore> calibrations_;
  std::unique_ptr<rig::Controller> rig_;  // null if no rig is configured
  std::unique_ptr<LeaseManager> leases_;
  std::unique_ptr<RigGateway> gateway_;
  std::unique_ptr<RigReference> places_;
  std::unique_ptr<DipExecutor> dips_;
  std::unique_ptr<PrintExecutor> prints_;
  CameraConfig camera_;
  std::unique_ptr<LiveCamera> live_;
  std::unique_ptr<CaptureExecutor> captures_;
  std::unique_ptr<WorkerExecutor> executor_;
  std::unique_ptr<WorkerPool> pool_;
  std::unique_ptr<PreviewPool> previews_;
  std::unique_ptr<CertificateReloader> certificate_;  // null without TLS
  std::string link_token_;
  std::unique_ptr<Server> server_;
  std::unique_ptr<JobMetrics> meter_;
  std::unique_ptr<http::Server> http_;
  Endpoint http_endpoint_;
  std::unique_ptr<RigMonitor> monitor_;
  std::atomic<bool> stopping_{false};
};

}  // namespace hydroprint::daemon
