#include "client/people.h"

#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "client/cli/commands/commands.h"
#include "client/cli/format/people_json.h"
#include "client/cli/program/program.h"
#include "client/cli/terminal/console.h"
#include "client/cli/terminal/secret.h"

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

Status show_user(const Program& program, const Result<client::User>& user) {
  HP_RETURN_IF_ERROR(user);
  if (program.json()) {
    print(to_json(*user));
  } else {
    std::cout << bare(user->name) << " is " << user->role << (user->disabled ? ", disabled" : "")
              << std::endl;
  }
  return {};
}

Status list_people(Program& program) {
  HP_ASSIGN_OR_RETURN(const auto users, client::list_users(program.daemon()));
  if (program.json()) {
    print({{"users", array_json(users)}});
    return {};
  }
  std::cout << std::left << std::setw(24) << "USER" << std::setw(10) << "ROLE" << std::setw(21)
            << "CREATED"
            << "PASSWORD\n";
  for (const client::User& user : users) {
    std::cout << std::setw(24) << bare(user.name) << std::setw(10) << user.role << std::setw(21)
              << format_time(user.create_time) << (user.has_password ? "yes" : "none")
              << (user.disabled ? ", disabled" : "") << "\n";
  }
  return {};
}

// The page's address differs from the daemon's and is not known here.
Status show_link(Program& program, const std::string& name) {
  HP_ASSIGN_OR_RETURN(const std::string token, client::create_sign_in_link(program.daemon(), name));
  if (program.json()) {
    print({{"user", name}, {"link_token", token}});
  } else {
    std::cout << bare(name)
              << " can sign in once, within 15 minutes, at the page's address followed by "
              << "/sign-in#" << token << std::endl;
  }
  return {};
}

Status add_user(Program& program, const UserOptions& options) {
  const std::string name = in_collection("users", options.name);
  std::string password;
  if (options.with_password) {
    HP_ASSIGN_OR_RETURN(password, ask_new_password());
  }
  return show_user(program, client::create_user(program.daemon(), name, options.role, password,
                                                options.returns));
}

Status set_user(Program& program, const UserOptions& options) {
  const auto role = options.role.empty() ? std::nullopt : std::optional(options.role);
  const auto disabled =
      options.disable || options.enable ? std::optional(options.disable) : std::nullopt;
  return show_user(
      program,
      client::update_user(program.daemon(), in_collection("users", options.name), role, disabled));
}

Status change_password(Program& program, const std::string& of) {
  HP_ASSIGN_OR_RETURN(const client::Identity me, client::who_am_i(program.daemon()));
  const bool is_own = of.empty() || in_collection("users", of) == "users/" + me.user;
  std::string old_password;
  if (is_own) {
    HP_ASSIGN_OR_RETURN(old_password, ask_secret("Old password (empty if none is set): "));
  }
  HP_ASSIGN_OR_RETURN(const std::string password, ask_new_password());
  return show_user(
      program, client::set_password(program.daemon(), in_collection("users", is_own ? me.user : of),
                                    old_password, password));
}

Status say_done(const Program& program, const std::string& name, const Status& done,
                const char* what) {
  HP_RETURN_IF_ERROR(done);
  if (program.json()) print({{what, name}});
  if (!program.json()) std::cout << printable(name) << " " << what << std::endl;
  return {};
}

void add_role(CLI::App& command, std::string& role) {
  command.add_option("--role", role, "The user's role")
      ->type_name("ROLE")
      ->transform(CLI::IsMember(client::role_names(), CLI::ignore_case));
}

CLI::App* add_named(CLI::App& parent, const char* verb, const char* help, std::string& name,
                    const char* what) {
  CLI::App* const command = parent.add_subcommand(verb, help);
  command->add_option("name", name, what)->type_name("NAME")->required();
  return command;
}

Status list_all_keys(Program& program) {
  HP_ASSIGN_OR_RETURN(const auto keys, client::list_api_keys(program.daemon()));
  if (program.json()) {
    print({{"api_keys", array_json(keys)}});
    return {};
  }
  std::cout << std::left << std::setw(18) << "KEY" << std::setw(16) << "USER" << std::setw(10)
            << "ROLE" << std::setw(21) << "LAST USED" << std::setw(21) << "ENDS"
            << "NAME\n";
  for (const client::ApiKey& key : keys) {
    std::cout << std::setw(18) << bare(key.name) << std::setw(16) << bare(key.user) << std::setw(10)
              << key.role << std::setw(21) << format_time(key.use_time) << std::setw(21)
              << format_time(key.expire_time) << printable(key.display_name) << "\n";
  }
  return {};
}

struct KeyOptions {
  std::string display_name, role;
  int days = 0;
};

Status add_key(Program& program, const KeyOptions& options) {
  HP_ASSIGN_OR_RETURN(const auto made,
                      client::create_api_key(program.daemon(), options.display_name, options.role,
                                             std::chrono::hours(24) * options.days));
  if (program.json()) {
    print({{"api_key", to_json(made.key)}, {"key", made.text}});
  } else {
    std::cerr
        << "This key is shown once. Set HYDROPRINT_API_KEY to it, or pass it to 'hydroprint login "
           "--api-key-stdin':\n";
    std::cout << made.text << std::endl;
  }
  return {};
}

Status list_all_sessions(Program& program) {
  HP_ASSIGN_OR_RETURN(const auto sessions, client::list_sessions(program.daemon()));
  if (program.json()) {
    print({{"sessions", array_json(sessions)}});
    return {};
  }
  std::cout << std::left << std::setw(18) << "SESSION" << std::setw(16) << "USER" << std::setw(21)
            << "LAST USED" << std::setw(21) << "ENDS"
            << "FROM\n";
  for (const client::Session& session : sessions) {
    std::cout << std::setw(18) << bare(session.name) << std::setw(16) << bare(session.user)
              << std::setw(21) << format_time(session.use_time) << std::setw(21)
              << format_time(session.expire_time) << printable(session.peer) << "\n";
  }
  return {};
}

struct AuditOptions {
  std::string who, what;
  int limit = 50;
};

Status show_audit(Program& program, const AuditOptions& options) {
  HP_ASSIGN_OR_RETURN(const auto entries, client::list_audit(program.daemon(), options.who,
                                                             options.what, options.limit));
  if (program.json()) {
    print({{"entries", array_json(entries)}});
    return {};
  }
  for (const client::AuditEntry& entry : entries) {
    std::cout << format_time(entry.time) << "  " << std::left << std::setw(16)
              << (entry.who.empty() ? "-" : printable(entry.who)) << std::setw(32)
              << printable(entry.what) << std::setw(18) << printable(entry.object) << entry.outcome
              << (entry.detail.empty() ? "" : "  " + printable(entry.detail)) << "\n";
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
                "This person had the name before and gets its jobs and files back");
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
    return say_done(program, name, client::delete_user(program.daemon(), name), "deleted");
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
    return say_done(program, full, client::delete_api_key(program.daemon(), full), "deleted");
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
    return say_done(program, full, client::revoke_session(program.daemon(), full), "revoked");
  });
}

void add_audit(CLI::App& app, Program& program) {
  auto options = std::make_shared<AuditOptions>();
  CLI::App* command = app.add_subcommand("audit", "Show the audit log, newest first");
  command->add_option("--who", options->who, "Only entries of this user")->type_name("NAME");
  command->add_option("--what", options->what, "Only methods whose names start with this")
      ->type_name("TEXT");
  command->add_option("--limit", options->limit, "Maximum number")
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
    HP_ASSIGN_OR_RETURN(const client::Job shared,
                        client::share_job(program.daemon(), job_name(*job), !*off));
    return say_done(program, shared.name, {}, *off ? "unshared" : "shared");
  });
}

}  // namespace hydroprint::cli
