#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <iostream>
#include <memory>
#include <string>

#include "client/cli/commands/commands.h"
#include "client/cli/format/json.h"
#include "client/cli/program/credentials.h"
#include "client/cli/program/program.h"
#include "client/cli/terminal/console.h"
#include "client/cli/terminal/secret.h"
#include "client/name_of.h"
#include "client/people.h"

namespace hydroprint::cli {
namespace {

constexpr std::chrono::hours kKeyHolds{24 * 90};

struct LoginOptions {
  std::string user;
  bool key_from_stdin = false;
  bool link_from_stdin = false;
};

std::string host_name() {
  std::array<char, 65> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "a machine";
}

// Returns "apiKeys/0a1b" for "hp_0a1b_SECRET".
std::string name_of_key(const std::string& key) {
  return "apiKeys/" + key.substr(3, key.find('_', 3) - 3);
}

Status show_identity(const Program& program, const v1::WhoAmIResponse& me) {
  if (program.json()) {
    print(me);
    return {};
  }
  std::cout << printable(me.user()) << " is " << client::name_of(me.role()) << " at "
            << program.server() << " (by " << printable(me.via()) << ")" << std::endl;
  if (!me.accounts()) {
    std::cout << "No users exist yet: every caller on that machine is an admin. Add the first "
                 "user with "
                 "'hydroprint users add NAME --role ADMIN'."
              << std::endl;
  }
  return {};
}

// Returns " of 20.0 GB", or nothing for an unlimited quota.
std::string of_allowed(const std::string& allowed, bool is_limited) {
  return is_limited ? " of " + allowed : "";
}

// Prints the caller's identity, then usage and quota.
Status show_all(Program& program) {
  HP_ASSIGN_OR_RETURN(const v1::WhoAmIResponse me, client::who_am_i(program.daemon()));
  HP_ASSIGN_OR_RETURN(const v1::Usage usage, client::get_usage(program.daemon()));
  if (program.json()) {
    Json json = to_json(me);
    json["usage"] = to_json(usage);
    print(json);
    return {};
  }
  HP_RETURN_IF_ERROR(show_identity(program, me));
  std::cout << fmt::format(
      "queued: {}{} jobs\nstored: {}{}", usage.queued_jobs(),
      of_allowed(fmt::to_string(usage.max_queued_jobs()), usage.max_queued_jobs() > 0),
      format_bytes(usage.stored_bytes()),
      of_allowed(format_bytes(usage.max_stored_bytes()), usage.max_stored_bytes() > 0));
  if (usage.pinned_bytes() > 0)
    std::cout << ", " << format_bytes(usage.pinned_bytes()) << " pinned";
  std::cout << std::endl;
  return {};
}

Result<std::string> begin_session(client::Connection& nobody, const LoginOptions& options) {
  if (options.link_from_stdin) {
    HP_ASSIGN_OR_RETURN(const std::string link, ask_secret("Sign-in link: "));
    // Accepts the whole link, or the part after "#".
    return client::sign_in_by_link(nobody, link.substr(link.rfind('#') + 1));
  }
  HP_ASSIGN_OR_RETURN(const std::string user, options.user.empty() ? ask("Name: ") : options.user);
  HP_ASSIGN_OR_RETURN(const std::string password, ask_secret("Password: "));
  return client::sign_in(nobody, user, password);
}

// Creates a key in a session that is closed afterwards.
Result<std::string> make_key(const Program& program, const LoginOptions& options) {
  client::Connection nobody(program.options_as("", ""));
  HP_ASSIGN_OR_RETURN(const std::string session, begin_session(nobody, options));
  client::Connection somebody(program.options_as("", session));
  v1::CreateApiKeyRequest request;
  request.set_display_name("hydroprint login on " + host_name());
  request.mutable_ttl()->set_seconds(std::chrono::seconds(kKeyHolds).count());
  const auto key = client::create_api_key(somebody, request);
  HP_RETURN_IF_ERROR(client::sign_out(somebody));
  HP_RETURN_IF_ERROR(key);
  return key->key();
}

Status log_in(Program& program, const LoginOptions& options) {
  HP_RETURN_IF_ERROR(client::check_secrets_may_go(program.options({})));
  HP_ASSIGN_OR_RETURN(const std::string key, options.key_from_stdin ? ask_secret("API key: ")
                                                                    : make_key(program, options));
  client::Connection connection(program.options_as(key, ""));
  HP_ASSIGN_OR_RETURN(const v1::WhoAmIResponse me, client::who_am_i(connection));
  if (!me.accounts()) {
    return fail(Code::kFailedPrecondition,
                fmt::format("{}: no users exist yet, so no login is needed", program.server()));
  }
  HP_RETURN_IF_ERROR(keep_key(program.server(), key));
  return show_identity(program, me);
}

// Deletes the stored key first, so that the logout takes effect on this machine even if the daemon
// does not respond.
Status log_out(const Program& program) {
  HP_ASSIGN_OR_RETURN(const std::string key, kept_key(program.server()));
  if (key.empty()) {
    return fail(Code::kFailedPrecondition,
                fmt::format("not logged in at {} on this machine", program.server()));
  }
  HP_RETURN_IF_ERROR(keep_key(program.server(), ""));
  client::Connection connection(program.options_as(key, ""));
  const Status ended = client::delete_api_key(connection, name_of_key(key));
  if (!ended && ended.error().code != Code::kUnauthenticated) {
    return fail(ended.error().code,
                fmt::format("the key was deleted here, but it is still valid at the daemon: {}; "
                            "log in and delete it with 'hydroprint keys delete'",
                            ended.error().message));
  }
  if (program.json()) print({{"loggedOut", program.server()}});
  if (!program.json()) std::cout << "logged out of " << program.server() << std::endl;
  return {};
}

}  // namespace

void add_login(CLI::App& app, Program& program) {
  auto options = std::make_shared<LoginOptions>();
  CLI::App* login = app.add_subcommand(
      "login",
      "Create an API key with a password or sign-in link, or use an existing key, and store it");
  login
      ->add_option("--user", options->user,
                   "Your user name; the command asks for it if it is omitted")
      ->type_name("NAME");
  auto* key = login->add_flag("--api-key-stdin", options->key_from_stdin,
                              "Read an API key from standard input");
  login
      ->add_flag("--link-stdin", options->link_from_stdin,
                 "Read a one-time sign-in link from standard input")
      ->excludes(key);
  login->footer("Example:\n  hydroprint login --api-key-stdin < key");
  program.on(*login, [&program, options] { return log_in(program, *options); });
  program.on(*app.add_subcommand("logout", "Delete the stored key and revoke it"),
             [&program] { return log_out(program); });
  program.on(*app.add_subcommand("whoami", "Show your user, role, usage and quota at the daemon"),
             [&program] { return show_all(program); });
}

}  // namespace hydroprint::cli
