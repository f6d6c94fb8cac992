#include "client/cli/program.h"

#include <pwd.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "client/cli/credentials.h"
#include "client/people.h"

namespace hydroprint::cli {
namespace {

constexpr int kUnreachable = 5;
constexpr std::size_t kOwnerMaxBytes = 64;

std::string login_name() {
  const passwd* entry = getpwuid(getuid());
  return entry != nullptr ? entry->pw_name : "";
}

std::string check_server(const std::string& text) {
  const auto colon = text.rfind(':');
  const bool good = colon != std::string::npos && colon > 0 && colon + 1 < text.size();
  return good ? "" : "'" + text + "' is not host:port, as in 127.0.0.1:50051";
}

std::string check_owner(const std::string& text) {
  const bool good =
      !text.empty() && text.size() <= kOwnerMaxBytes &&
      std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c <= '~'; });
  return good ? "" : "an owner is 1 to 64 printable ASCII characters without blanks";
}

}  // namespace

Program::Program(CLI::App& app) : owner_(login_name()) {
  app.add_option("--server", server_, "Where hydroprintd listens")
      ->type_name("HOST:PORT")
      ->envname("HYDROPRINT_SERVER")
      ->check(check_server)
      ->capture_default_str();
  app.add_option("--owner", owner_, "In whose name, where there are no users; owners take turns")
      ->type_name("NAME")
      ->envname("HYDROPRINT_OWNER")
      ->check(check_owner)
      ->capture_default_str();
  app.add_flag("--json", json_, "Print JSON, for scripts");
  app.set_version_flag("--version", std::string("hydroprint ") + HYDROPRINT_VERSION);
}

void Program::on(CLI::App& command, std::function<Status()> action) {
  command.callback([this, action = std::move(action)] { action_ = action; });
}

Status Program::run() {
  const char* const key = std::getenv("HYDROPRINT_API_KEY");
  if (key != nullptr && *key != '\0') {
    key_ = key;
  } else {
    HP_ASSIGN_OR_RETURN(key_, kept_key(server_));
  }
  return action_();
}

Result<std::string> Program::own_name() {
  if (key_.empty()) return owner_;
  HP_ASSIGN_OR_RETURN(client::Identity me, client::who_am_i(daemon()));
  return std::move(me).user;
}

client::ConnectionOptions Program::options(std::stop_token stop) const {
  return {server_, owner_, key_, "", std::move(stop)};
}

client::Connection& Program::daemon() {
  if (!daemon_) {
    interrupt_ = std::make_unique<Interrupt>();
    daemon_ = std::make_unique<client::Connection>(options(interrupt_->token()));
  }
  return *daemon_;
}

client::Connection Program::uninterrupted() const { return client::Connection(options({})); }

std::string job_name(const std::string& text) {
  const bool is_number = !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
  return is_number ? "jobs/" + text : text;
}

std::string calibration_name(const std::string& text) {
  const bool is_number = !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
  return is_number || text == "active" ? "calibrations/" + text : text;
}

void add_stale_flag(CLI::App& command, bool& is_allowed) {
  command.add_flag("--allow-stale-calibration", is_allowed,
                   "Go by the calibration even if the rig moved since, or it is of another object");
}

void add_job_argument(CLI::App& command, std::string& job) {
  command.add_option("job", job, "The job: jobs/7, or 7")->type_name("JOB")->required();
}

int exit_code(const Error& error) {
  if (error.code == Code::kUnavailable) return kUnreachable;
  // Damaged at the daemon or on its way to us: no input of the user's is bad.
  if (error.code == Code::kDataLoss) return static_cast<int>(ExitStatus::kFailed);
  return static_cast<int>(exit_status(error));
}

}  // namespace hydroprint::cli
