#include <fmt/format.h>
#include <pthread.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <iostream>

#include "daemon/admin/admin.h"
#include "daemon/config/bind_policy.h"
#include "daemon/config/executable_path.h"
#include "daemon/config/rig_config_check.h"
#include "daemon/daemon.h"
#include "daemon/platform/log.h"
#include "daemon/platform/systemd_notify.h"
#include "sim/base/utf8.h"

namespace {

using namespace hydroprint;          // NOLINT(google-build-using-namespace): the program itself
using namespace hydroprint::daemon;  // NOLINT(google-build-using-namespace)

constexpr timespec kCleanUpEvery{3600, 0};

struct Options {
  std::string config_file;
  bool check_config = false;
  std::string state_dir;
  std::string grpc;
  std::string http;
  std::string first_admin;
  std::string tls_certificate;
  std::string tls_key;
  std::string rig;
  std::string rig_profile;
};

int refuse(const std::string& message, ExitStatus status) {
  std::cerr << "hydroprintd: " << one_line(message) << '\n';
  return static_cast<int>(status);
}

LogLevel log_level(const std::string& name) {
  if (name == "debug") return LogLevel::kDebug;
  if (name == "warning") return LogLevel::kWarning;
  return name == "error" ? LogLevel::kError : LogLevel::kInfo;
}

std::string beside(const char* argv0, const char* program) {
  const char* const search_path = std::getenv("PATH");
  const auto self = own_program(argv0, search_path == nullptr ? "" : search_path);
  return self.parent_path() / program;
}

// Returns the folder of the web client's files: the installed one, otherwise that of the build
// tree.
std::string web_dir(const char* argv0) {
  const std::filesystem::path bin = beside(argv0, "");
  const auto installed = (bin / "../../share/hydroprint/web").lexically_normal();
  std::error_code ignored;
  if (std::filesystem::is_directory(installed, ignored)) return installed;
  return (bin / "../../web").lexically_normal();
}

Result<Config> configure(const Options& options, const char* argv0) {
  Config config;
  if (!options.config_file.empty()) {
    HP_ASSIGN_OR_RETURN(config, read_config(options.config_file));
  }
  if (!options.state_dir.empty()) config.store_state_dir = options.state_dir;
  if (!options.grpc.empty()) config.server_grpc = options.grpc;
  if (!options.http.empty()) config.server_http = options.http;
  if (!options.tls_certificate.empty()) config.server_tls_certificate = options.tls_certificate;
  if (!options.tls_key.empty()) config.server_tls_key = options.tls_key;
  if (!options.rig.empty()) config.rig_drive = options.rig;
  if (!options.rig_profile.empty()) config.rig_profile = options.rig_profile;
  if (config.workers_program.empty()) config.workers_program = beside(argv0, "hydroprint-worker");
  config.confine_program = beside(argv0, "hydroprint-confine");
  if (config.camera_program.empty()) config.camera_program = beside(argv0, "hydroprint-capture");
  if (config.server_web_dir.empty()) config.server_web_dir = web_dir(argv0);
  if (const auto endpoint = parse_endpoint(config.server_grpc); !endpoint) {
    return fail(Code::kInvalidArgument, "--grpc: " + endpoint.error().message);
  }
  if (const auto endpoint = parse_endpoint(config.server_http); !endpoint) {
    return fail(Code::kInvalidArgument, "--http: " + endpoint.error().message);
  }
  HP_RETURN_IF_ERROR(check_exposure(config));
  if (!config.server_tls_certificate.empty()) {
    HP_RETURN_IF_ERROR(tls::Identity::read(config.server_tls_certificate, config.server_tls_key));
  }
  HP_RETURN_IF_ERROR(read_controller_config(config));
  return config;
}

// Blocks the signals that main receives with sigtimedwait(); threads inherit the mask.
sigset_t block_signals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGTERM);
  sigaddset(&set, SIGINT);
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  signal(SIGPIPE, SIG_IGN);
  return set;
}

// Raises the limit on descriptors to the maximum, because a server without free descriptors stops
// responding.
void raise_descriptor_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  setrlimit(RLIMIT_NOFILE, &limit);
}

void serve_until_signal(Daemon& daemon, const sigset_t& signals) {
  for (;;) {
    const int signal = sigtimedwait(&signals, nullptr, &kCleanUpEvery);
    if (signal > 0) {
      log(LogLevel::kInfo, "stopping", {{"signal", signal}});
      return;
    }
    if (errno == EAGAIN) daemon.clean_up();
  }
}

int run(const Config& config, const std::string& first_admin) {
  const sigset_t signals = block_signals();
  raise_descriptor_limit();
  umask(077);
  if (const Status started = start_logging(log_level(config.log_level), config.log_file);
      !started) {
    return refuse(started.error().message, ExitStatus::kBadInput);
  }
  const auto daemon = Daemon::start(config, first_admin);
  if (!daemon) return refuse(daemon.error().message, ExitStatus::kFailed);
  const std::string grpc = (*daemon)->endpoint().text(), http = (*daemon)->http_endpoint().text();
  if (const std::string link = (*daemon)->sign_in_link(); !link.empty()) {
    std::cout << "hydroprintd sign-in link, once within 15 minutes: " << link << std::endl;
  }
  log(LogLevel::kInfo, "ready",
      {{"grpc", grpc},
       {"http", http},
       {"page", (*daemon)->page_address()},
       {"state_dir", (*daemon)->layout().root.string()}});
  std::cout << "hydroprintd ready grpc=" << grpc << " http=" << http
            << " state_dir=" << (*daemon)->layout().root.string() << std::endl;
  notify_ready(fmt::format("serving gRPC at {}, {}", grpc, (*daemon)->page_address()));
  {
    const WatchdogFeeder feeder([&daemon] { return (*daemon)->control_rounds(); });
    serve_until_signal(**daemon, signals);
  }
  notify_stopping();
  (*daemon)->stop();
  log(LogLevel::kInfo, "stopped");
  return 0;
}

int run_command(int argc, char** argv) {
  if (argc > 1 && std::string_view(argv[1]) == "admin") {
    return admin::run_command(argc - 1, argv + 1,
                              [argv](const std::string& config_file, const std::string& state_dir) {
                                Options options;
                                options.config_file = config_file;
                                options.state_dir = state_dir;
                                return configure(options, argv[0]);
                              });
  }
  Options options;
  CLI::App app(
      "Keeps Hydroprint's job queue and runs its workers. Serves gRPC and HTTP on loopback "
      "or, with TLS and accounts, on other addresses.");
  app.name("hydroprintd");
  app.set_version_flag("--version", "hydroprintd " HYDROPRINT_VERSION);
  app.add_option("--config", options.config_file, "TOML file; default: built-in settings")
      ->type_name("FILE");
  app.add_flag("--check-config", options.check_config, "Check the configuration and exit");
  app.add_option("--state-dir", options.state_dir,
                 "Folder for jobs; default $XDG_STATE_HOME/hydroprint or "
                 "~/.local/state/hydroprint")
      ->type_name("DIR");
  app.add_option("--grpc", options.grpc,
                 "Address and port to listen on; default 127.0.0.1:50051; port 0: any free port; "
                 "other addresses than loopback require TLS and an admin who can sign in")
      ->type_name("HOST:PORT");
  app.add_option("--http", options.http, "Same as --grpc, for HTTP; default 127.0.0.1:8080")
      ->type_name("HOST:PORT");
  app.add_option(
         "--tls-certificate", options.tls_certificate,
         "PEM file of the certificate for gRPC and HTTP, followed by its chain; loaded again "
         "when it changes; default: no TLS")
      ->type_name("FILE");
  app.add_option("--tls-key", options.tls_key, "PEM file of the certificate's key")
      ->type_name("FILE");
  app.add_option("--first-admin", options.first_admin,
                 "Print a link with which this user signs in as admin once, within 15 minutes; "
                 "creates the user if needed")
      ->type_name("NAME");
  app.add_option("--rig", options.rig,
                 "Address of the motor's drive, such as tcp:127.0.0.1:1502; default: no rig")
      ->type_name("ENDPOINT");
  app.add_option("--rig-profile", options.rig_profile, "Profile of the motor's drive")
      ->type_name("FILE");
  app.footer("hydroprintd admin --help: backup, restore and other commands for the state folder.");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : static_cast<int>(ExitStatus::kUsage);
  }
  const auto config = configure(options, argv[0]);
  if (!config) return refuse(config.error().message, ExitStatus::kBadInput);
  if (!options.check_config) return run(*config, options.first_admin);
  std::cout << "the configuration is valid\n";
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run_command(argc, argv);
  } catch (const std::exception& error) {
    return refuse(error.what(), ExitStatus::kFailed);
  }
}
