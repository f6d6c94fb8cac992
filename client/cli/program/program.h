#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <string>

#include "client/cli/terminal/interrupt.h"
#include "client/connection/connection.h"
#include "sim/base/result.h"

namespace hydroprint::cli {

/// State shared by all commands: the global flags and the connection to the daemon.
class Program {
 public:
  /// Adds --server, --ca, --owner, --json and --version.
  explicit Program(CLI::App& app);

  /// Registers `action` to run if `command` is on the command line, without a subcommand.
  void on(CLI::App& command, std::function<Status()> action);
  /// Runs the chosen action, with the stored API key if there is one.
  [[nodiscard]] Status run();

  [[nodiscard]] bool json() const { return json_; }
  /// Returns "host:port".
  [[nodiscard]] const std::string& server() const { return server_; }
  /// Returns the owner of new jobs: the user, or --owner if there are no users.
  [[nodiscard]] Result<std::string> own_name();
  /// Returns options for a separate connection as the same caller.
  [[nodiscard]] client::ConnectionOptions options(std::stop_token stop) const;
  /// Returns options for a connection with other credentials; both empty: anonymous.
  [[nodiscard]] client::ConnectionOptions options_as(const std::string& key,
                                                     const std::string& session) const;
  /// Returns the connection to the daemon. After the first call, Ctrl-C ends its calls with
  /// kCancelled.
  [[nodiscard]] client::Connection& daemon();
  /// Returns whether Ctrl-C was pressed after the first call of daemon().
  [[nodiscard]] bool is_interrupted() const {
    return interrupt_ && interrupt_->token().stop_requested();
  }
  /// Returns a separate connection that Ctrl-C does not affect.
  [[nodiscard]] client::Connection uninterrupted() const;

 private:
  [[nodiscard]] Status find_server();

  std::string server_ = client::ConnectionOptions().server;
  std::string ca_file_, ca_pem_;
  bool is_tls_ = false;
  std::string owner_;
  std::string key_;  ///< from HYDROPRINT_API_KEY or login; empty: none
  bool json_ = false;
  std::function<Status()> action_;
  std::unique_ptr<Interrupt> interrupt_;
  std::unique_ptr<client::Connection> daemon_;
};

/// Returns "jobs/7" for "7" or "jobs/7". Returns other text unchanged; the daemon will reject it.
[[nodiscard]] std::string job_name(const std::string& text);

/// Returns "calibrations/3" for "3" or "calibrations/3", and "calibrations/active" for "active".
[[nodiscard]] std::string calibration_name(const std::string& text);

/// Adds the positional argument JOB.
void add_job_argument(CLI::App& command, std::string& job);

/// Returns the program's exit status: as in sim/base/result.h, but 5 if no daemon responds, and 4
/// (failed) if bytes arrive damaged.
[[nodiscard]] int exit_code(const Error& error);

}  // namespace hydroprint::cli
