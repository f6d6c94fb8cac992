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

// "ann" or "users/ann" to "users/ann".
std::string in_collection(const std::string& collection, const std::string& text) {
  return text.starts_with(collection + "/") ? text : collection + "/" + text;
}

std::string bare(const std::string& name) { return printable(name.substr(name.find('/') + 1)); }

Status show_user(const Program& program, const Result<client::User>& user) {
  HP_RETURN_IF_ERROR(user);
  if (program.json()) {
    print(to_json(*user));
  } else {
    std::cout << bare(user->name) << " is " << user->role << (user->disabled ? ", and barred" : "")
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
              << (user.disabled ? ", barred" : "") << "\n";
  }
  return {};
}

// The page's address is not the daemon's, and not known here.
Status show_link(Program& program, const std::string& name) {
  HP_ASSIGN_OR_RETURN(const std::string token, client::create_sign_in_link(program.daemon(), name));
  if (program.json()) {
    print({{"user", name}, {"link_token", token}});
  } else {
    std::cout << bare(name)
              << " signs in once, within 15 minutes, at the page's address followed by "
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
    HP_ASSIGN_OR_RETURN(old_password, ask_secret("Old password (empty if there is none): "));
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
  command.add_option("--role", role, "What they may do")
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
    std::cerr << "This is shown once; give it as HYDROPRINT_API_KEY, or to hydroprint login "
                 "--api-key-stdin:\n";
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
  CLI::App* users = app.add_subcommand("users", "Who may use the daemon");
  users->require_subcommand(1);
  program.on(*users->add_subcommand("list", "List all users"),
             [&program] { return list_people(program); });

  CLI::App* add = add_named(*users, "add", "Add a user", options->name, "The new user's");
  add_role(*add, options->role);
  add->get_option("--role")->required();
  add->add_flag("--password", options->with_password,
                "Ask for a password; else see users link, or users password");
  add->add_flag("--returns", options->returns,
                "They had this name before, and get back what bears it");
  add->footer("Example:\n  hydroprint users add ann --role ADMIN --password");
  program.on(*add, [&program, options] { return add_user(program, *options); });

  CLI::App* set = add_named(*users, "set", "Change what a user may do", options->name, "Whose");
  add_role(*set, options->role);
  auto* const disable = set->add_flag("--disable", options->disable, "Bar them");
  set->add_flag("--enable", options->enable, "Admit them again")->excludes(disable);
  program.on(*set, [&program, options] { return set_user(program, *options); });

  CLI::App* password = users->add_subcommand("password", "Set your password, or somebody's");
  password->add_option("name", options->name, "Whose; default: yours")->type_name("NAME");
  program.on(*password, [&program, options] { return change_password(program, options->name); });

  CLI::App* link = add_named(*users, "link", "Make a link by which a user signs in once",
                             options->name, "Whose");
  program.on(*link, [&program, options] {
    return show_link(program, in_collection("users", options->name));
  });

  CLI::App* remove =
      add_named(*users, "delete", "Delete a user; their jobs stay", options->name, "Whom");
  program.on(*remove, [&program, options] {
    const std::string name = in_collection("users", options->name);
    return say_done(program, name, client::delete_user(program.daemon(), name), "deleted");
  });
}

void add_keys(CLI::App& app, Program& program) {
  CLI::App* keys = app.add_subcommand("keys", "API keys, which stand for you in scripts");
  keys->require_subcommand(1);
  program.on(*keys->add_subcommand("list", "List your keys; as an admin all"),
             [&program] { return list_all_keys(program); });
  auto options = std::make_shared<KeyOptions>();
  CLI::App* add = keys->add_subcommand("add", "Make a key and print it, this once");
  add->add_option("--name", options->display_name, "What it is for")->type_name("TEXT");
  add_role(*add, options->role);
  add->add_option("--days", options->days, "How long it holds; default: until it is deleted")
      ->type_name("N")
      ->check(CLI::Range(1, 3650));
  program.on(*add, [&program, options] { return add_key(program, *options); });
  auto name = std::make_shared<std::string>();
  CLI::App* remove = add_named(*keys, "delete", "End a key", *name, "Which");
  program.on(*remove, [&program, name] {
    const std::string full = in_collection("apiKeys", *name);
    return say_done(program, full, client::delete_api_key(program.daemon(), full), "deleted");
  });
}

void add_sessions(CLI::App& app, Program& program) {
  CLI::App* sessions = app.add_subcommand("sessions", "Who is signed in");
  sessions->require_subcommand(1);
  program.on(*sessions->add_subcommand("list", "List your sessions; as an admin all"),
             [&program] { return list_all_sessions(program); });
  auto name = std::make_shared<std::string>();
  CLI::App* revoke = add_named(*sessions, "revoke", "End a session", *name, "Which");
  program.on(*revoke, [&program, name] {
    const std::string full = in_collection("sessions", *name);
    return say_done(program, full, client::revoke_session(program.daemon(), full), "revoked");
  });
}

void add_audit(CLI::App& app, Program& program) {
  auto options = std::make_shared<AuditOptions>();
  CLI::App* command = app.add_subcommand("audit", "What was done and by whom, newest first");
  command->add_option("--who", options->who, "Only what this user did")->type_name("NAME");
  command->add_option("--what", options->what, "Only methods whose name begins so")
      ->type_name("TEXT");
  command->add_option("--limit", options->limit, "At most so many")
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
      app.add_subcommand("share", "Let all who may look see a job's artifacts and files");
  add_job_argument(*command, *job);
  command->add_flag("--off", *off, "No longer");
  program.on(*command, [&program, job, off]() -> Status {
    HP_ASSIGN_OR_RETURN(const client::Job shared,
                        client::share_job(program.daemon(), job_name(*job), !*off));
    return say_done(program, shared.name, {}, *off ? "unshared" : "shared");
  });
}

}  // namespace hydroprint::cli
