#include "client/cli/program/program.h"

#include <fmt/format.h>
#include <pwd.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <utility>

#include "client/cli/program/credentials.h"
#include "client/connection/server_address.h"
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
  const auto address = client::parse_server(text);
  return address ? "" : address.error().message;
}

Result<std::string> read_authorities(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::string pem{std::istreambuf_iterator<char>(in), {}};
  if (in && pem.find("-----BEGIN CERTIFICATE-----") != std::string::npos) return pem;
  return fail(Code::kInvalidArgument,
              fmt::format("--ca (HYDROPRINT_CA) {}: no readable certificate; use a PEM file with "
                          "the certificate of the authority that signed the daemon's certificate",
                          file));
}

std::string check_owner(const std::string& text) {
  const bool good =
      !text.empty() && text.size() <= kOwnerMaxBytes &&
      std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c <= '~'; });
  return good ? "" : "use 1 to 64 printable ASCII characters without spaces";
}

}  // namespace

Program::Program(CLI::App& app) : owner_(login_name()) {
  app.add_option("--server", server_,
                 "Address of hydroprintd; for TLS: https://HOST:PORT, implied by --ca")
      ->type_name("HOST:PORT")
      ->envname("HYDROPRINT_SERVER")
      ->check(check_server)
      ->capture_default_str();
  app.add_option("--ca", ca_file_,
                 "PEM file of trusted authorities, instead of the system's; implies TLS")
      ->type_name("FILE")
      ->envname("HYDROPRINT_CA");
  app.add_option(
         "--owner", owner_,
         "Owner of new jobs, if there are no user accounts; the queue alternates between owners")
      ->type_name("NAME")
      ->envname("HYDROPRINT_OWNER")
      ->check(check_owner)
      ->capture_default_str();
  app.add_flag("--json", json_, "Print the JSON of the REST API, for scripts");
  app.set_version_flag("--version", std::string("hydroprint ") + HYDROPRINT_VERSION);
}

void Program::on(CLI::App& command, std::function<Status()> action) {
  command.callback([this, &command, action = std::move(action)] {
    if (command.get_subcommands().empty()) action_ = action;
  });
}

Status Program::find_server() {
  HP_ASSIGN_OR_RETURN(const client::ServerAddress address, client::parse_server(server_));
  server_ = address.text();
  is_tls_ = address.is_tls || !ca_file_.empty();
  if (ca_file_.empty()) return {};
  HP_ASSIGN_OR_RETURN(ca_pem_, read_authorities(ca_file_));
  return {};
}

Status Program::run() {
  HP_RETURN_IF_ERROR(find_server());
  const char* const key = std::getenv("HYDROPRINT_API_KEY");
  if (key != nullptr && *key != '\0') {
    key_ = key;
  } else {
    HP_ASSIGN_OR_RETURN(key_, kept_key(server_));
  }
  if (!key_.empty()) HP_RETURN_IF_ERROR(client::check_secrets_may_go(options({})));
  return action_();
}

Result<std::string> Program::own_name() {
  if (key_.empty()) return owner_;
  HP_ASSIGN_OR_RETURN(const v1::WhoAmIResponse me, client::who_am_i(daemon()));
  return me.user();
}

client::ConnectionOptions Program::options(std::stop_token stop) const {
  return {server_, owner_, key_, "", std::move(stop), is_tls_, ca_pem_};
}

client::ConnectionOptions Program::options_as(const std::string& key,
                                              const std::string& session) const {
  return {server_, "", key, session, {}, is_tls_, ca_pem_};
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

void add_job_argument(CLI::App& command, std::string& job) {
  command.add_option("job", job, "The job: jobs/7, or 7")->type_name("JOB")->required();
}

int exit_code(const Error& error) {
  if (error.code == Code::kUnavailable) return kUnreachable;
  // The data was damaged at the daemon or in transit, so this is not an input error.
  if (error.code == Code::kDataLoss) return static_cast<int>(ExitStatus::kFailed);
  return static_cast<int>(exit_status(error));
}

}  // namespace hydroprint::cli
