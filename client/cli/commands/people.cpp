#include "client/people.h"

#include <fmt/format.h>

#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "client/cli/commands/commands.h"
#include "client/cli/format/json.h"
#include "client/cli/program/program.h"
#include "client/cli/terminal/console.h"
#include "client/cli/terminal/secret.h"
#include "client/name_of.h"
#include "client/time.h"

namespace hydroprint::cli {
namespace {

struct UserOptions {
  std::string name;
  std::string role;
  bool with_password = false;
  bool returns = false;
  bool disable = false, enable = false;
};

// Returns "users/ann" for "ann" or "users/ann".
std::string in_collection(const std::string& collection, const std::string& text) {
  return text.starts_with(collection + "/") ? text : collection + "/" + text;
}

std::string bare(const std::string& name) { return printable(name.substr(name.find('/') + 1)); }

// Returns the role with this name; ROLE_UNSPECIFIED if the name is empty.
v1::Role role_of(const std::string& name) {
  v1::Role role = v1::ROLE_UNSPECIFIED;
  v1::Role_Parse(name, &role);
  return role;
}

Status show_user(const Program& program, const Result<v1::User>& user) {
  HP_RETURN_IF_ERROR(user);
  if (program.json()) {
    print(*user);
  } else {
    std::cout << bare(user->name()) << " is " << client::name_of(user->role())
              << (user->disabled() ? ", disabled" : "") << std::endl;
  }
  return {};
}

Status list_people(Program& program) {
  HP_ASSIGN_OR_RETURN(const auto list, client::list_users(program.daemon()));
  if (program.json()) {
    print(list);
    return {};
  }
  constexpr const char* kRow = "{:<24}{:<10}{:<21}{}{}\n";
  std::cout << fmt::format(kRow, "USER", "ROLE", "CREATED", "PASSWORD", "");
  for (const v1::User& user : list.users()) {
    std::cout << fmt::format(kRow, bare(user.name()), client::name_of(user.role()),
                             format_time(client::time_of(user.create_time())),
                             user.has_password() ? "yes" : "none",
                             user.disabled() ? ", disabled" : "");
  }
  return {};
}

// The address of the web page is not known here: it differs from that of the gRPC endpoint.
Status show_link(Program& program, const std::string& name) {
  HP_ASSIGN_OR_RETURN(const auto link, client::create_sign_in_link(program.daemon(), name));
  if (program.json()) {
    print(link);
  } else {
    std::cout << bare(name)
              << " can sign in once, within 15 minutes, at the page's address followed by "
              << "/sign-in#" << link.token() << std::endl;
  }
  return {};
}

Status add_user(Program& program, const UserOptions& options) {
  v1::CreateUserRequest request;
  request.mutable_user()->set_name(in_collection("users", options.name));
  request.mutable_user()->set_role(role_of(options.role));
  request.set_returns(options.returns);
  if (options.with_password) {
    HP_ASSIGN_OR_RETURN(*request.mutable_password(), ask_new_password());
  }
  return show_user(program, client::create_user(program.daemon(), request));
}

Status set_user(Program& program, const UserOptions& options) {
  v1::UpdateUserRequest request;
  request.set_name(in_collection("users", options.name));
  if (!options.role.empty()) request.set_role(role_of(options.role));
  if (options.disable || options.enable) request.set_disabled(options.disable);
  return show_user(program, client::update_user(program.daemon(), request));
}

Status change_password(Program& program, const std::string& of) {
  HP_ASSIGN_OR_RETURN(const auto me, client::who_am_i(program.daemon()));
  const bool is_own = of.empty() || in_collection("users", of) == "users/" + me.user();
  v1::SetPasswordRequest request;
  request.set_name(in_collection("users", is_own ? me.user() : of));
  if (is_own) {
    HP_ASSIGN_OR_RETURN(*request.mutable_old_password(),
                        ask_secret("Old password (empty if none is set): "));
  }
  HP_ASSIGN_OR_RETURN(*request.mutable_new_password(), ask_new_password());
  return show_user(program, client::set_password(program.daemon(), request));
}

Status print_outcome(const Program& program, const std::string& name, const Status& done,
                     const char* what) {
  HP_RETURN_IF_ERROR(done);
  if (program.json()) print({{what, name}});
  if (!program.json()) std::cout << printable(name) << " " << what << std::endl;
  return {};
}

// Returns the names of all roles.
std::vector<std::string> role_names() {
  std::vector<std::string> names;
  for (int i = 1; i < v1::Role_descriptor()->value_count(); ++i)
    names.push_back(v1::Role_descriptor()->value(i)->name());
  return names;
}

void add_role(CLI::App& command, std::string& role) {
  command.add_option("--role", role, "The user's role")
      ->type_name("ROLE")
      ->transform(CLI::IsMember(role_names(), CLI::ignore_case));
}

CLI::App* add_named(CLI::App& parent, const char* verb, const char* help, std::string& name,
                    const char* what) {
  CLI::App* const command = parent.add_subcommand(verb, help);
  command->add_option("name", name, what)->type_name("NAME")->required();
  return command;
}

Status list_all_keys(Program& program) {
  HP_ASSIGN_OR_RETURN(const auto list, client::list_api_keys(program.daemon()));
  if (program.json()) {
    print(list);
    return {};
  }
  constexpr const char* kRow = "{:<18}{:<16}{:<10}{:<21}{:<21}{}\n";
  std::cout << fmt::format(kRow, "KEY", "USER", "ROLE", "LAST USED", "ENDS", "NAME");
  for (const v1::ApiKey& key : list.api_keys()) {
    std::cout << fmt::format(kRow, bare(key.name()), bare(key.user()), client::name_of(key.role()),
                             format_time(client::time_of(key.use_time())),
                             format_time(client::time_of(key.expire_time())),
                             printable(key.display_name()));
  }
  return {};
}

struct KeyOptions {
  std::string display_name, role;
  int days = 0;
};

Status add_key(Program& program, const KeyOptions& options) {
  v1::CreateApiKeyRequest request;
  request.set_display_name(options.display_name);
  if (!options.role.empty()) request.set_role(role_of(options.role));
  const std::chrono::seconds ttl = std::chrono::hours(24) * options.days;
  if (ttl.count() > 0) request.mutable_ttl()->set_seconds(ttl.count());
  HP_ASSIGN_OR_RETURN(const auto api_key, client::create_api_key(program.daemon(), request));
  if (program.json()) {
    print(api_key);
  } else {
    std::cerr
        << "This key is shown once. Set HYDROPRINT_API_KEY to it, or pass it to 'hydroprint login "
           "--api-key-stdin':\n";
    std::cout << api_key.key() << std::endl;
  }
  return {};
}

Status list_all_sessions(Program& program) {
  HP_ASSIGN_OR_RETURN(const auto list, client::list_sessions(program.daemon()));
  if (program.json()) {
    print(list);
    return {};
  }
  constexpr const char* kRow = "{:<18}{:<16}{:<21}{:<21}{}\n";
  std::cout << fmt::format(kRow, "SESSION", "USER", "LAST USED", "ENDS", "FROM");
  for (const v1::Session& session : list.sessions()) {
    std::cout << fmt::format(kRow, bare(session.name()), bare(session.user()),
                             format_time(client::time_of(session.use_time())),
                             format_time(client::time_of(session.expire_time())),
                             printable(session.peer()));
  }
  return {};
}

struct AuditOptions {
  std::string who, what;
  int limit = 50;
};

Status show_audit(Program& program, const AuditOptions& options) {
  HP_ASSIGN_OR_RETURN(const auto list, client::list_audit(program.daemon(), options.who,
                                                          options.what, options.limit));
  if (program.json()) {
    print(list);
    return {};
  }
  for (const v1::AuditEntry& entry : list.entries()) {
    std::cout << fmt::format("{}  {:<16}{:<32}{:<18}{}{}{}\n",
                             format_time(client::time_of(entry.time())),
                             entry.who().empty() ? "-" : printable(entry.who()),
                             printable(entry.what()), printable(entry.object()), entry.outcome(),
                             entry.detail().empty() ? "" : "  ", printable(entry.detail()));
  }
  return {};
}

}  // namespace

void add_users(CLI::App& app, Program& program) {
  auto options = std::make_shared<UserOptions>();
  CLI::App* users = app.add_subcommand("users", "Manage the daemon's users");
  users->require_subcommand(1);
  program.on(*users->add_subcommand("list", "List all users"),
             [&program] { return list_people(program); });

  CLI::App* add = add_named(*users, "add", "Add a user", options->name, "Name of the new user");
  add_role(*add, options->role);
  add->get_option("--role")->required();
  add->add_flag("--password", options->with_password,
                "Ask for a password; otherwise use 'users link' or 'users password'");
  add->add_flag("--returns", options->returns,
                "Restore the deleted user of that name, with the jobs and files of that user");
  add->footer("Example:\n  hydroprint users add ann --role ADMIN --password");
  program.on(*add, [&program, options] { return add_user(program, *options); });

  CLI::App* set = add_named(*users, "set", "Change a user's role, disable or enable the user",
                            options->name, "User name");
  add_role(*set, options->role);
  auto* const disable = set->add_flag("--disable", options->disable, "Disable the user");
  set->add_flag("--enable", options->enable, "Enable the user again")->excludes(disable);
  program.on(*set, [&program, options] { return set_user(program, *options); });

  CLI::App* password = users->add_subcommand("password", "Set your password, or another user's");
  password->add_option("name", options->name, "User name; default: yours")->type_name("NAME");
  program.on(*password, [&program, options] { return change_password(program, options->name); });

  CLI::App* link = add_named(*users, "link", "Create a link that signs a user in once",
                             options->name, "User name");
  program.on(*link, [&program, options] {
    return show_link(program, in_collection("users", options->name));
  });

  CLI::App* remove = add_named(*users, "delete", "Delete a user; the user's jobs are kept",
                               options->name, "User name");
  program.on(*remove, [&program, options] {
    const std::string name = in_collection("users", options->name);
    return print_outcome(program, name, client::delete_user(program.daemon(), name), "deleted");
  });
}

void add_keys(CLI::App& app, Program& program) {
  CLI::App* keys =
      app.add_subcommand("keys", "Manage API keys, which let scripts act with your permissions");
  keys->require_subcommand(1);
  program.on(*keys->add_subcommand("list", "List your keys; as an admin, all keys"),
             [&program] { return list_all_keys(program); });
  auto options = std::make_shared<KeyOptions>();
  CLI::App* add = keys->add_subcommand("add", "Create a key and print it once");
  add->add_option("--name", options->display_name, "Purpose of the key")->type_name("TEXT");
  add_role(*add, options->role);
  add->add_option("--days", options->days, "Days until it expires; default: does not expire")
      ->type_name("N")
      ->check(CLI::Range(1, 3650));
  program.on(*add, [&program, options] { return add_key(program, *options); });
  auto name = std::make_shared<std::string>();
  CLI::App* remove = add_named(*keys, "delete", "Delete a key", *name, "Name of the key");
  program.on(*remove, [&program, name] {
    const std::string full = in_collection("apiKeys", *name);
    return print_outcome(program, full, client::delete_api_key(program.daemon(), full), "deleted");
  });
}

void add_sessions(CLI::App& app, Program& program) {
  CLI::App* sessions = app.add_subcommand("sessions", "Manage sign-in sessions");
  sessions->require_subcommand(1);
  program.on(*sessions->add_subcommand("list", "List your sessions; as an admin, all sessions"),
             [&program] { return list_all_sessions(program); });
  auto name = std::make_shared<std::string>();
  CLI::App* revoke = add_named(*sessions, "revoke", "End a session", *name, "Name of the session");
  program.on(*revoke, [&program, name] {
    const std::string full = in_collection("sessions", *name);
    return print_outcome(program, full, client::revoke_session(program.daemon(), full), "revoked");
  });
}

void add_audit(CLI::App& app, Program& program) {
  auto options = std::make_shared<AuditOptions>();
  CLI::App* command = app.add_subcommand("audit", "Show the audit log, newest first");
  command->add_option("--who", options->who, "Only entries of this user")->type_name("NAME");
  command->add_option("--what", options->what, "Only methods whose names start with this")
      ->type_name("TEXT");
  command->add_option("--limit", options->limit, "Maximum number of entries")
      ->type_name("N")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command->footer("Example:\n  hydroprint audit --what RigService. --limit 20");
  program.on(*command, [&program, options] { return show_audit(program, *options); });
}

void add_share(CLI::App& app, Program& program) {
  auto job = std::make_shared<std::string>();
  auto off = std::make_shared<bool>(false);
  CLI::App* command =
      app.add_subcommand("share", "Share a job's artifacts and files with all users");
  add_job_argument(*command, *job);
  command->add_flag("--off", *off, "Stop sharing");
  program.on(*command, [&program, job, off]() -> Status {
    HP_ASSIGN_OR_RETURN(const v1::Job shared,
                        client::share_job(program.daemon(), job_name(*job), !*off));
    if (program.json()) print(shared);
    if (!program.json())
      std::cout << shared.name() << " " << (*off ? "unshared" : "shared") << std::endl;
    return {};
  });
}

}  // namespace hydroprint::cli
