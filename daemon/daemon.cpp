#include "daemon/daemon.h"

#include <fmt/format.h>
#include <sched.h>

#include <algorithm>
#include <sstream>

#include "daemon/config/bind_policy.h"
#include "daemon/config/rig_config_check.h"
#include "daemon/confine/landlock.h"
#include "daemon/metrics/health.h"
#include "daemon/platform/log.h"
#include "daemon/store/database/schema.h"
#include "daemon/workers/slurm/slurm_executor.h"

namespace hydroprint::daemon {
namespace {

constexpr std::int64_t kMiB = 1 << 20;
constexpr std::int64_t kHourMs = 3600LL * 1000;
constexpr std::chrono::milliseconds kPatience{1000};

// Returns the number of cores that this process may use. In a container or under taskset, these may
// be fewer than the machine has.
int core_count() {
  cpu_set_t set;
  return ::sched_getaffinity(0, sizeof set, &set) == 0 ? std::max(1, CPU_COUNT(&set)) : 1;
}

int worker_slots(const Config& config) {
  return config.workers_count > 0 ? static_cast<int>(config.workers_count) : core_count();
}

PoolOptions pool_options(const Config& config) {
  PoolOptions options;
  options.program = config.workers_program;
  options.confine_program = config.confine_program;
  // On nodes, whose cores are unknown, a worker gets one unless workers.threads says otherwise.
  options.cores = config.workers_executor == kLocalExecutor ? core_count() : 1;
  options.threads = static_cast<int>(config.workers_threads);
  options.memory_bytes = config.workers_memory_mib * kMiB;
  options.time_limit_s = config.workers_time_limit_s;
  options.file_bytes = config.workers_file_mib * kMiB;
  options.needs_landlock = !config.workers_allow_without_landlock;
  return options;
}

Result<std::unique_ptr<WorkerExecutor>> make_executor(const Config& config) {
  if (config.workers_executor == kLocalExecutor) {
    return std::make_unique<LocalExecutor>(worker_slots(config));
  }
  HP_ASSIGN_OR_RETURN(auto slurm, slurm::SlurmExecutor::make(slurm::settings_of(config), {}));
  return slurm;
}

PreviewOptions preview_options(const PoolOptions& pool) {
  const std::int64_t a_day_s = 24LL * 3600;  // limit on the processor time of one worker
  return {pool.program,
          pool.confine_program,
          pool.threads > 0 ? pool.threads : core_count(),
          {pool.memory_bytes, a_day_s, pool.file_bytes, pool.needs_landlock}};
}

Quota quota_of(const Config& config) {
  return {config.queue_max_jobs_per_owner, config.store_max_mib_per_owner * kMiB};
}

Result<std::filesystem::path> state_dir(const Config& config) {
  if (config.store_state_dir.empty()) return default_state_dir();
  return std::filesystem::absolute(config.store_state_dir).lexically_normal();
}

void log_failure(const char* event, const Status& status) {
  if (!status) log(LogLevel::kError, event, {{"message", status.error().message}});
}

}  // namespace

Result<std::unique_ptr<Daemon>> Daemon::start(const Config& config,
                                              const std::string& first_admin) {
  std::unique_ptr<Daemon> daemon(new Daemon);
  HP_ASSIGN_OR_RETURN(daemon->layout_.root, state_dir(config));
  HP_RETURN_IF_ERROR(check_build(daemon->layout_.database()));
  HP_ASSIGN_OR_RETURN(daemon->lock_, lock_state(daemon->layout_));
  HP_RETURN_IF_ERROR(correct_modes(daemon->layout_));
  HP_RETURN_IF_ERROR(check_restored(daemon->layout_));
  HP_RETURN_IF_ERROR(daemon->open_store(config));
  HP_RETURN_IF_ERROR(daemon->open_certificate(config));
  HP_RETURN_IF_ERROR(daemon->open_people(config));
  if (!first_admin.empty()) HP_RETURN_IF_ERROR(daemon->make_first_admin(first_admin));
  HP_RETURN_IF_ERROR(check_admin(config, *daemon->accounts_));
  HP_RETURN_IF_ERROR(daemon->open_rig(config));
  HP_RETURN_IF_ERROR(daemon->open_printer(config));
  HP_RETURN_IF_ERROR(daemon->open_camera(config));
  HP_RETURN_IF_ERROR(daemon->start_serving(config));
  return daemon;
}

Status Daemon::open_store(const Config& config) {
  HP_ASSIGN_OR_RETURN(database_, daemon::open_store(layout_.database()));
  job_changes_ =
      std::make_unique<JobChanges>(*database_,
                                   RetentionTimes{config.store_keep_finished_days * 24 * kHourMs,
                                                  config.store_keep_dips_days * 24 * kHourMs},
                                   system_clock_ms);
  jobs_ = std::make_unique<JobStore>(*job_changes_, layout_,
                                     JobStoreOptions{config.queue_max_jobs, quota_of(config)});
  queue_ = std::make_unique<JobQueue>(*job_changes_);
  device_jobs_ = std::make_unique<DeviceJobs>(*job_changes_);
  job_retention_ = std::make_unique<JobRetention>(*job_changes_, layout_);
  assets_ = std::make_unique<AssetStore>(*database_, layout_, system_clock_ms);
  uploads_ = std::make_unique<Uploads>(
      *database_, *assets_, layout_,
      UploadOptions{config.assets_max_mib * kMiB, config.assets_max_open_uploads,
                    config.assets_upload_expires_h * kHourMs, config.store_min_free_mib * kMiB,
                    quota_of(config)},
      system_clock_ms);
  asset_retention_ = std::make_unique<AssetRetention>(
      *database_, layout_, config.assets_keep_unused_days * 24 * kHourMs, system_clock_ms);
  calibrations_ = std::make_unique<CalibrationStore>(*database_, system_clock_ms);
  HP_ASSIGN_OR_RETURN(executor_, make_executor(config));
  return repair_store();
}

Status Daemon::repair_store() {
  HP_ASSIGN_OR_RETURN(const auto kept, surviving(*executor_, *jobs_));
  // sweep() comes first, since it may free disk space that the next step needs.
  HP_RETURN_IF_ERROR(job_retention_->sweep(kept));
  executor_->keep_only(kept);
  HP_RETURN_IF_ERROR(end_lost_dips(*device_jobs_, layout_));
  HP_RETURN_IF_ERROR(jobs_->interrupt_all(Interruption::kLoss, kept));
  HP_RETURN_IF_ERROR(asset_retention_->sweep());
  clean_up();
  return {};
}

Status Daemon::open_people(const Config& config) {
  auth::AccountsOptions options;
  options.password_cost = {config.people_password_memory_mib << 10, config.people_password_passes};
  options.sessions.idle_ms = config.people_session_idle_h * kHourMs;
  options.sessions.most_ms = config.people_session_days * 24 * kHourMs;
  HP_ASSIGN_OR_RETURN(accounts_, auth::Accounts::open(*database_, options, system_clock_ms));
  audit_ = std::make_unique<auth::AuditLog>(*database_, system_clock_ms);
  // Access without a user must not become possible from other machines by mistake.
  const bool is_open = config.people_accounts == "loopback-open" && !is_exposed(config);
  access_ = std::make_unique<Authenticator>(*accounts_, is_open);
  outside_ = std::make_unique<auth::ExternalChanges>(*database_, *accounts_);
  if (!is_open && !accounts_->users().any()) {
    log(LogLevel::kWarning, "no_users",
        {{"message",
          "accounts are required, but no user exists; start the daemon with --first-admin "
          "NAME"}});
  }
  return {};
}

Status Daemon::open_certificate(const Config& config) {
  HP_RETURN_IF_ERROR(check_exposure(config));
  if (config.server_tls_certificate.empty()) return {};
  HP_ASSIGN_OR_RETURN(
      certificate_, CertificateReloader::open(config.server_tls_certificate, config.server_tls_key,
                                              system_clock_ms));
  if (confine::is_within_ruleset(config.server_tls_key, config.workers_program)) {
    log(LogLevel::kWarning, "key_within_fence",
        {{"message",
          fmt::format(
              "{}: workers, which read untrusted files, can also read this TLS key; move the key "
              "to /var/lib/hydroprint, or to another folder that workers cannot read",
              config.server_tls_key)}});
  }
  return {};
}

tls::CurrentIdentity Daemon::identity() const {
  if (!certificate_) return {};
  return [keeper = certificate_.get()] { return keeper->current(); };
}

std::string Daemon::page_address() const {
  if (!certificate_) return fmt::format("http://{}/", http_endpoint_.text());
  for (const std::string& name : certificate_->current()->names()) {
    const bool is_for_all = name != "localhost" || http_endpoint_.is_loopback();
    if (name.starts_with('*') || !is_for_all) continue;
    return fmt::format("https://{}:{}/", name, http_endpoint_.port);
  }
  return fmt::format("https://{}/", http_endpoint_.text());
}

std::string Daemon::sign_in_link() const {
  return link_token_.empty() ? "" : page_address() + "sign-in#" + link_token_;
}

Status Daemon::make_first_admin(const std::string& name) {
  HP_RETURN_IF_ERROR(auth::check_user_name("name", name));
  const auto found = accounts_->users().get(name);
  if (!found) {
    HP_RETURN_IF_ERROR(accounts_->users().create({name, auth::Role::kAdmin, false, "", 0}, ""));
  } else if (found->role != auth::Role::kAdmin || found->disabled) {
    return fail(
        Code::kFailedPrecondition,
        fmt::format("--first-admin: {} exists but is not an active admin; name another user", name),
        ErrorReason::STATE_FORBIDS);
  }
  HP_ASSIGN_OR_RETURN(const auto link, accounts_->sessions().make_link(name));
  auth::AuditEntry entry;
  entry.via = "command line";
  entry.what = "hydroprintd --first-admin";
  entry.object = "users/" + name;
  entry.outcome = "OK";
  audit_->wait_written(audit_->note(std::move(entry)), kPatience);
  link_token_ = link.first;
  return {};
}

// The drive may be absent at startup; the controller keeps trying to connect.
Status Daemon::open_rig(const Config& config) {
  HP_ASSIGN_OR_RETURN(auto setup, read_controller_config(config));
  if (setup) {
    HP_ASSIGN_OR_RETURN(rig_, rig::Controller::make(setup->config, std::move(setup->profile),
                                                    std::move(setup->endpoint)));
  }
  leases_ = std::make_unique<LeaseManager>(*database_, system_clock_ms);
  HP_RETURN_IF_ERROR(leases_->load());
  gateway_ = std::make_unique<RigGateway>(rig_.get(), *leases_);
  places_ = std::make_unique<RigReference>(*database_, rig_.get());
  HP_RETURN_IF_ERROR(places_->load());
  dips_ = std::make_unique<DipExecutor>(DipDependencies{*gateway_, *places_, *jobs_, *device_jobs_,
                                                        *calibrations_, layout_, system_clock_ms});
  return {};
}

// The printer may be absent at startup.
Status Daemon::open_printer(const Config& config) {
  HP_ASSIGN_OR_RETURN(auto setup, read_printer_setup(config));
  prints_ = std::make_unique<PrintExecutor>(std::move(setup), *jobs_, *device_jobs_, layout_);
  return {};
}

// The camera may be absent at startup.
Status Daemon::open_camera(const Config& config) {
  HP_ASSIGN_OR_RETURN(camera_, read_camera_setup(config));
  HP_ASSIGN_OR_RETURN(live_, LiveCamera::make(camera_, layout_, system_clock_ms));
  HP_ASSIGN_OR_RETURN(captures_,
                      CaptureExecutor::make({camera_, *live_, *jobs_, *calibrations_, *gateway_,
                                             *places_, layout_, system_clock_ms}));
  return {};
}

Status Daemon::start_serving(const Config& config) {
  HP_ASSIGN_OR_RETURN(
      const std::string warning,
      check_confinement(config.confine_program, !config.workers_allow_without_landlock));
  if (!warning.empty()) log(LogLevel::kWarning, "files_not_fenced", {{"message", warning}});
  PoolOptions workers = pool_options(config);
  workers.confinement_warning = warning;
  HP_ASSIGN_OR_RETURN(
      pool_, WorkerPool::make(workers, *executor_, *jobs_, *queue_, layout_, system_clock_ms));
  HP_ASSIGN_OR_RETURN(previews_, PreviewPool::make(preview_options(pool_options(config)), layout_));
  const ServiceContext backend{*database_,       *accounts_,  *audit_,
                               *access_,         *jobs_,      *queue_,
                               *job_retention_,  *assets_,    *uploads_,
                               *pool_,           *gateway_,   *dips_,
                               *captures_,       executors(), *calibrations_,
                               *previews_,       *live_,      *places_,
                               camera_,          layout_,     config.store_min_free_mib * kMiB,
                               quota_of(config), stopping_};
  HP_ASSIGN_OR_RETURN(const Endpoint endpoint, parse_endpoint(config.server_grpc));
  HP_ASSIGN_OR_RETURN(server_,
                      Server::start(endpoint, config.server_reflection, backend, identity()));
  HP_RETURN_IF_ERROR(start_http(config, backend));
  pool_->start();
  monitor_ = std::make_unique<RigMonitor>(*gateway_, *places_,
                                          [this](bool works) { server_->set_rig_serving(works); });
  return {};
}

Status Daemon::start_http(const Config& config, const ServiceContext& backend) {
  HP_ASSIGN_OR_RETURN(http_endpoint_, parse_endpoint(config.server_http));
  meter_ = std::make_unique<JobMetrics>(*jobs_);
  http::Options options{http_endpoint_.host,   http_endpoint_.port, {},
                        config.server_web_dir, http::Limits{},      identity()};
  std::istringstream names(config.server_host_names);
  for (std::string name; names >> name;) options.host_names.push_back(name);
  http::Sources sources;
  sources.admit = [&roles = server_->roles()](std::string_view method,
                                              const auth::Credentials& credentials) {
    return roles.admit(method, credentials);
  };
  sources.health = [backend] {
    HealthReport report = health_report(backend);
    return http::Health{report.is_good, std::move(report.json)};
  };
  sources.metrics = [backend, this] { return metrics_text(backend, *meter_, certificate_.get()); };
  HP_ASSIGN_OR_RETURN(http_,
                      http::Server::start(options, server_->in_process(), std::move(sources)));
  http_endpoint_.port = http_->port();
  return {};
}

Daemon::~Daemon() { stop(); }

Executors Daemon::executors() const { return {*dips_, *prints_, *captures_, *pool_}; }

std::optional<std::uint64_t> Daemon::control_rounds() const {
  if (!rig_) return {};
  return rig_->snapshot().jitter.ticks;
}

void Daemon::clean_up() {
  log_failure("jobs_not_purged", job_retention_->purge());
  log_failure("uploads_not_purged", asset_retention_->purge());
  if (!accounts_) return;  // nothing to do before accounts are open
  log_failure("sessions_not_purged", accounts_->clean_up());
  log_failure("audit_not_purged", audit_->clean_up());
}

// Executions that go on keep their jobs RUNNING for the next daemon.
Status Daemon::interrupt_jobs() {
  HP_ASSIGN_OR_RETURN(const auto kept, surviving(*executor_, *jobs_));
  return jobs_->interrupt_all(Interruption::kShutdown, kept);
}

void Daemon::stop() {
  if (stopping_.exchange(true) || !server_) return;
  if (http_) http_->stop_accepting();
  jobs_->notifier().ring();
  for (JobExecutor* const executor : executors()) executor->stop();
  live_->stop();
  previews_->stop();
  monitor_.reset();
  server_->stop(kPatience);
  if (http_) http_->stop();
  meter_.reset();
  rig_.reset();  // brings the axis to rest
  log_failure("jobs_not_queued_again", interrupt_jobs());
}

}  // namespace hydroprint::daemon
