#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <string>

#include "client/cli/terminal/interrupt.h"
#include "client/connection/connection.h"
#include "sim/base/result.h"

namespace hydroprint::cli {

/// What every command shares: the flags that all of them take, and the way to the daemon.
class Program {
 public:
  /// Adds --server, --ca, --owner, --json and --version.
  explicit Program(CLI::App& app);

  /// Makes `action` what happens once the command line is read, if `command` stands on it.
  void on(CLI::App& command, std::function<Status()> action);
  /// Runs the action chosen, with the API key that is there.
  [[nodiscard]] Status run();

  [[nodiscard]] bool json() const { return json_; }
  /// "host:port".
  [[nodiscard]] const std::string& server() const { return server_; }
  /// Whose name jobs are created in: the user's, or --owner where there are none.
  [[nodiscard]] Result<std::string> own_name();
  /// Where the daemon is and who asks it, for a connection of one's own.
  [[nodiscard]] client::ConnectionOptions options(std::stop_token stop) const;
  /// Where the daemon is, for somebody else: nobody with these empty.
  [[nodiscard]] client::ConnectionOptions options_as(const std::string& key,
                                                     const std::string& session) const;
  /// The daemon; from the first call on, Ctrl-C ends its calls with kCancelled.
  [[nodiscard]] client::Connection& daemon();
  /// Whether Ctrl-C came since then.
  [[nodiscard]] bool is_interrupted() const {
    return interrupt_ && interrupt_->token().stop_requested();
  }
  /// Another connection, which Ctrl-C does not end.
  [[nodiscard]] client::Connection uninterrupted() const;

 private:
  [[nodiscard]] Status find_server();

  std::string server_ = client::ConnectionOptions().server;
  std::string ca_file_, ca_pem_;
  bool is_tls_ = false;
  std::string owner_;
  std::string key_;  ///< HYDROPRINT_API_KEY, or what login kept for the server; empty: none
  bool json_ = false;
  std::function<Status()> action_;
  std::unique_ptr<Interrupt> interrupt_;
  std::unique_ptr<client::Connection> daemon_;
};

/// "7" or "jobs/7" to "jobs/7"; anything else is left to the daemon to refuse.
[[nodiscard]] std::string job_name(const std::string& text);

/// "3", "active" or "calibrations/3" to "calibrations/3", "calibrations/active".
[[nodiscard]] std::string calibration_name(const std::string& text);

/// Adds --allow-stale-calibration.
void add_stale_flag(CLI::App& command, bool& is_allowed);

/// Adds the positional argument JOB.
void add_job_argument(CLI::App& command, std::string& job);

/// The exit status of the program: as of every program here (sim/base/result.h), but 5 if no daemon
/// answers, and 4 (failed) where bytes arrive damaged.
[[nodiscard]] int exit_code(const Error& error);

}  // namespace hydroprint::cli
