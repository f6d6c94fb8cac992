#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "hardware/rig/config.h"
#include "sim/base/result.h"

namespace hydroprint::daemon {

/// All settings with their defaults: one member for each key of the TOML file. Comments state
/// section and key; deploy/hydroprintd.toml.example explains each.
struct Config {
  std::string server_grpc = "127.0.0.1:50051";  ///< server.grpc: address and port; port 0: any free
  bool server_reflection = true;                ///< server.reflection
  std::string server_http = "127.0.0.1:8080";   ///< server.http: address and port for HTTP
  std::string server_host_names;                ///< server.host_names, separated by spaces
  std::string server_tls_certificate;           ///< server.tls_certificate: file; empty: no TLS
  std::string server_tls_key;                   ///< server.tls_key: file; empty: no TLS
  std::string server_web_dir;                   ///< server.web_dir; empty: as installed
  std::string store_state_dir;                  ///< store.state_dir; empty: the user's default
  std::int64_t store_keep_finished_days = 30;   ///< store.keep_finished_days; 0: forever
  std::int64_t store_keep_dips_days = 365;      ///< store.keep_dips_days; 0: forever
  std::int64_t store_max_mib_per_owner = 20480;  ///< store.max_mib_per_owner; 0: no limit
  std::int64_t store_min_free_mib = 512;         ///< store.min_free_mib
  std::int64_t assets_max_mib = 1024;            ///< assets.max_mib, per file
  std::int64_t assets_max_open_uploads = 64;     ///< assets.max_open_uploads
  std::int64_t assets_upload_expires_h = 24;     ///< assets.upload_expires_h
  std::int64_t assets_keep_unused_days = 30;     ///< assets.keep_unused_days; 0: forever
  std::int64_t queue_max_jobs = 1000;            ///< queue.max_jobs
  std::int64_t queue_max_jobs_per_owner = 200;   ///< queue.max_jobs_per_owner; 0: no limit
  std::string workers_program;                   ///< workers.program; empty: next to hydroprintd
  std::string confine_program;                   ///< hydroprint-confine; not a key of the file
  std::int64_t workers_count = 0;                ///< workers.count; 0: number of cores
  /// workers.threads per worker; 0: the cores are divided among the workers.
  std::int64_t workers_threads = 0;
  std::int64_t workers_memory_mib = 4096;    ///< workers.memory_mib per worker; 0: no limit
  std::int64_t workers_time_limit_s = 3600;  ///< workers.time_limit_s per job
  std::int64_t workers_file_mib = 4096;      ///< workers.file_mib, per file that a worker writes
  /// workers.allow_without_landlock: also run workers on a kernel without Landlock.
  bool workers_allow_without_landlock = false;
  std::string workers_executor = "local";      ///< workers.executor: "local" or "slurm"
  std::string slurm_folder;                    ///< workers.slurm.folder, shared with all nodes
  std::string slurm_installation = "default";  ///< workers.slurm.installation
  std::string slurm_partition;                 ///< workers.slurm.partition; empty: Slurm's default
  std::string slurm_account;                   ///< workers.slurm.account; empty: the user's default
  std::string slurm_options;     ///< workers.slurm.options: options of sbatch, separated by spaces
  std::int64_t slurm_jobs = 16;  ///< workers.slurm.jobs: how many are handed over at most
  std::string rig_drive;         ///< rig.drive: "tcp:HOST:PORT" or "rtu:..."; empty: no rig
  std::string rig_profile;       ///< rig.profile: file with the drive's profile
  rig::RigConfig rig;            ///< all other keys of [rig]
  std::string printer_address;   ///< printer.address: "ipp://..."; empty: no printer
  std::int64_t printer_patience_s = 20;      ///< printer.patience_s: timeout for answers
  std::int64_t printer_time_limit_s = 3600;  ///< printer.time_limit_s per job
  std::string camera_device;                 ///< camera.device: OpenNI2's name; empty: no camera
  std::string camera_program;                ///< camera.program; empty: next to hydroprintd
  std::int64_t camera_patience_s = 5;        ///< camera.patience_s: timeout for answers
  std::string camera_layout;           ///< camera.layout: file that describes markers and camera
  double camera_gripper_water_mm = 0;  ///< camera.gripper_water_mm; 0: unknown
  std::string people_accounts = "loopback-open";  ///< people.accounts: this or "required"
  std::int64_t people_password_memory_mib = 64;   ///< people.password_memory_mib
  std::int64_t people_password_passes = 3;        ///< people.password_passes
  std::int64_t people_session_idle_h = 12;        ///< people.session_idle_h
  std::int64_t people_session_days = 7;           ///< people.session_days
  std::string log_level = "info";                 ///< log.level: debug, info, warning, error
  std::string log_file;                           ///< log.file, in addition to stderr; empty: none

  bool operator==(const Config&) const = default;
};

/// Returns the names of all keys, "section.key", in the order of deploy/hydroprintd.toml.example.
[[nodiscard]] std::vector<std::string> config_keys();

/// Reads and checks a TOML file; missing keys keep their defaults.
/// @return kNotFound if the file cannot be read; kInvalidArgument, as one line with file, line and
///         remedy, for invalid TOML, an unknown key, a wrong type or a value out of range
[[nodiscard]] Result<Config> read_config(const std::filesystem::path& path);

/// Same as read_config(), for text that was read from `name`.
[[nodiscard]] Result<Config> parse_config(std::string_view text, const std::string& name);

/// An address to listen on.
struct Endpoint {
  std::string host;  ///< an IP address, never a host name: "127.0.0.1", "::1", "0.0.0.0"
  int port = 0;      ///< 0: any free port

  /// Returns "127.0.0.1:50051" or "[::1]:50051".
  [[nodiscard]] std::string text() const;
  /// Returns whether only this machine can reach the address.
  [[nodiscard]] bool is_loopback() const;
};

/// Parses "127.0.0.1:50051", "[::1]:50051", "localhost:50051", or an address beyond loopback, which
/// bind_policy.h checks.
/// @return kInvalidArgument for anything else, such as a host name
[[nodiscard]] Result<Endpoint> parse_endpoint(std::string_view text);

/// Returns the default state folder, $XDG_STATE_HOME/hydroprint or ~/.local/state/hydroprint;
/// kFailedPrecondition if neither XDG_STATE_HOME nor HOME is set.
[[nodiscard]] Result<std::filesystem::path> default_state_dir();

}  // namespace hydroprint::daemon
