#include "daemon/admin/admin.h"

#include <sys/stat.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <iostream>

#include "daemon/admin/backup.h"
#include "daemon/admin/check.h"
#include "daemon/admin/damaged_database.h"
#include "daemon/admin/offline_accounts.h"
#include "daemon/admin/restore.h"
#include "sim/base/number_text.h"
#include "sim/base/utf8.h"

namespace hydroprint::admin {
namespace {

struct Options {
  std::string state_dir, config_file, file, user;
  bool replaces = false, from_stdin = false;
};

void print_contents(const Contents& contents) {
  std::cout << contents.jobs << " jobs and " << contents.files << " files, "
            << format_bytes(contents.bytes) << std::endl;
}

Status run_backup(const Options& options) {
  HP_ASSIGN_OR_RETURN(State state, open_state(options.state_dir));
  state.lock.reset();  // a daemon may start from here on
  HP_ASSIGN_OR_RETURN(const Contents contents, backup(state, options.file));
  for (const std::string& warning : contents.warnings) {
    std::cerr << "warning: " << one_line(warning) << std::endl;
  }
  std::cout << one_line(options.file) << ": ";
  print_contents(contents);
  return {};
}

Status run_restore(const Options& options) {
  HP_ASSIGN_OR_RETURN(const Contents contents,
                      restore(options.state_dir, options.file, options.replaces));
  std::cout << "restored ";
  print_contents(contents);
  return {};
}

Status run_reset(const Options& options) {
  if (!options.from_stdin) {
    return fail(Code::kInvalidArgument,
                "the password is read from standard input: add --stdin, or run hydroprint admin, "
                "which asks for it");
  }
  std::string password;
  std::getline(std::cin, password);
  HP_ASSIGN_OR_RETURN(State state, open_state(options.state_dir));
  HP_RETURN_IF_ERROR(reset_password(state, options.user, password));
  std::cout << one_line(options.user) << " has a new password; all of their sessions have ended"
            << std::endl;
  return {};
}

Status run_link(const Options& options) {
  HP_ASSIGN_OR_RETURN(State state, open_state(options.state_dir));
  HP_ASSIGN_OR_RETURN(const std::string token, sign_in_link(state, options.user));
  std::cout << one_line(options.user)
            << " can sign in once within 15 minutes, at the page's address followed by /sign-in#"
            << token << std::endl;
  return {};
}

Status run_set_aside(const Options& options) {
  HP_ASSIGN_OR_RETURN(const auto path, set_database_aside(options.state_dir));
  std::cout << "the database is now " << one_line(path.string())
            << "; the daemon starts with an empty one, without users and jobs, and sets all other "
               "files aside; hydroprint admin restore --replace FILE restores a backup instead"
            << std::endl;
  return {};
}

int run_check(const Options& options, const Configure& configure) {
  const std::string file = configuration_file(options.config_file);
  return static_cast<int>(check(file, configure(file, options.state_dir)));
}

CLI::App* add(CLI::App& app, const char* name, const char* help, Options& options) {
  CLI::App* const verb = app.add_subcommand(name, help);
  verb->add_option("--state-dir", options.state_dir, "The daemon's state folder")->type_name("DIR");
  return verb;
}

}  // namespace

int run_command(int argc, char** argv, const Configure& configure) {
  ::umask(077);
  std::signal(SIGPIPE, SIG_IGN);
  Options options;
  CLI::App app("Administration on the daemon's machine, for hydroprint admin");
  app.name("hydroprintd admin");
  app.require_subcommand(1);
  CLI::App* const to_backup = add(app, "backup", "Write a backup of all data to one file", options);
  to_backup->add_option("file", options.file)->required();
  CLI::App* const to_restore = add(app, "restore", "Restore a backup", options);
  to_restore->add_option("file", options.file)->required();
  to_restore->add_flag("--replace", options.replaces, "Replace the content of the state folder");
  CLI::App* const to_reset = add(app, "reset-password", "Set a user's password", options);
  to_reset->add_option("user", options.user)->required();
  to_reset->add_flag("--stdin", options.from_stdin, "Read the password from standard input");
  CLI::App* const to_link =
      add(app, "sign-in-link", "Create a link that signs the user in once", options);
  to_link->add_option("user", options.user)->required();
  CLI::App* const to_set_aside = add(app, "set-aside", "Set a damaged database aside", options);
  CLI::App* const to_check =
      add(app, "check", "Check whether the daemon can run workers, and its data", options);
  to_check->add_option("--config", options.config_file, "The daemon's configuration")
      ->type_name("FILE");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : static_cast<int>(ExitStatus::kUsage);
  }
  if (to_check->parsed()) return run_check(options, configure);
  const Status done = to_backup->parsed()      ? run_backup(options)
                      : to_restore->parsed()   ? run_restore(options)
                      : to_reset->parsed()     ? run_reset(options)
                      : to_set_aside->parsed() ? run_set_aside(options)
                                               : run_link(options);
  if (done) return 0;
  std::cerr << "hydroprint: " << one_line(done.error().message) << std::endl;
  return static_cast<int>(exit_status(done.error()));
}

}  // namespace hydroprint::admin
