#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "client/cli/commands/commands.h"
#include "client/cli/program/program.h"
#include "client/cli/terminal/secret.h"

// These commands act on the daemon's state folder and run on its machine. The program "hydroprintd
// admin" does the work; this file defines the command line and asks for confirmation.
namespace hydroprint::cli {
namespace {

struct AdminOptions {
  std::string state_dir, config_file, file, user;
  bool from_stdin = false;  // no effect: input that is not a terminal is read in any case
  bool replace = false;
};

// Returns the path of hydroprintd if it is next to this program; otherwise its name, which is
// searched in PATH.
std::string daemon_program() {
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  const auto beside = self.parent_path() / "hydroprintd";
  return !error && std::filesystem::exists(beside, error) ? beside.string() : "hydroprintd";
}

// Replaces this process with hydroprintd; returns only on failure.
Status become(const std::vector<std::string>& arguments) {
  std::vector<std::string> words{daemon_program(), "admin"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> raw;
  raw.reserve(words.size() + 1);
  for (std::string& word : words) raw.push_back(word.data());
  raw.push_back(nullptr);
  ::execvp(raw.front(), raw.data());
  return fail(Code::kFailedPrecondition,
              fmt::format("{}: cannot be started ({}); run this command on the machine where "
                          "hydroprintd is installed",
                          words.front(), std::generic_category().message(errno)));
}

std::vector<std::string> arguments_of(const std::string& verb, const AdminOptions& options) {
  std::vector<std::string> arguments{verb};
  if (!options.state_dir.empty()) {
    arguments.insert(arguments.end(), {"--state-dir", options.state_dir});
  }
  return arguments;
}

Status on_file(const std::string& verb, const AdminOptions& options) {
  std::vector<std::string> arguments = arguments_of(verb, options);
  if (options.replace) arguments.emplace_back("--replace");
  arguments.insert(arguments.end(), {"--", options.file});
  return become(arguments);
}

Status link(const AdminOptions& options) {
  std::vector<std::string> arguments = arguments_of("sign-in-link", options);
  arguments.insert(arguments.end(), {"--", options.user});
  return become(arguments);
}

// The password is passed through a pipe, which buffers it until hydroprintd reads it. It appears
// neither on a command line nor in a file.
Status reset_password(const AdminOptions& options) {
  HP_ASSIGN_OR_RETURN(const std::string password, ask_new_password());
  constexpr std::size_t kLongestPassword = 1000;  // bytes; a pipe accepts them in one write
  if (password.size() > kLongestPassword) {
    return fail(Code::kInvalidArgument,
                "the password has more than 1000 bytes; choose a shorter one");
  }
  int ends[2] = {-1, -1};
  const std::string line = password + "\n";
  if (::pipe(ends) != 0 || ::dup2(ends[0], STDIN_FILENO) < 0 ||
      ::write(ends[1], line.data(), line.size()) != static_cast<ssize_t>(line.size())) {
    return fail(Code::kInternal, "cannot create a pipe: " + std::generic_category().message(errno));
  }
  ::close(ends[0]);
  ::close(ends[1]);
  std::vector<std::string> arguments = arguments_of("reset-password", options);
  arguments.insert(arguments.end(), {"--stdin", "--", options.user});
  return become(arguments);
}

Status check(const AdminOptions& options) {
  std::vector<std::string> arguments = arguments_of("check", options);
  if (!options.config_file.empty()) {
    arguments.insert(arguments.end(), {"--config", options.config_file});
  }
  return become(arguments);
}

CLI::App* add_verb(CLI::App& admin, const char* name, const char* help, AdminOptions& options) {
  CLI::App* const verb = admin.add_subcommand(name, help);
  verb->add_option("--state-dir", options.state_dir,
                   "The daemon's state folder; default: that of a daemon run by the current user")
      ->type_name("DIR");
  return verb;
}

}  // namespace

void add_admin(CLI::App& app, Program& program) {
  auto options = std::make_shared<AdminOptions>();
  CLI::App* admin = app.add_subcommand(
      "admin", "Back up, restore, reset passwords, check; on the daemon's machine, as its user");
  admin->require_subcommand(1);

  CLI::App* backup =
      add_verb(*admin, "backup",
               "Write the daemon's whole state to one file; the daemon may be running", *options);
  backup->add_option("file", options->file, "The archive to create (tar); must not exist")
      ->type_name("FILE")
      ->required();
  backup->footer(
      "Example:\n  sudo -u hydroprint hydroprint admin backup --state-dir "
      "/var/lib/hydroprint /backups/hydroprint-$(date +%F).tar");
  program.on(*backup, [options] { return on_file("backup", *options); });

  CLI::App* restore =
      add_verb(*admin, "restore", "Restore a backup; the daemon must be stopped", *options);
  restore->add_option("file", options->file, "The archive")->type_name("FILE")->required();
  restore->add_flag("--replace", options->replace,
                    "Delete the current contents of the state folder");
  program.on(*restore, [options] { return on_file("restore", *options); });

  CLI::App* reset = add_verb(*admin, "reset-password",
                             "Set a user's password and end the user's sessions", *options);
  reset->add_option("user", options->user, "User name")->type_name("NAME")->required();
  reset->add_flag("--stdin", options->from_stdin, "Read the password from standard input");
  program.on(*reset, [options] { return reset_password(*options); });

  CLI::App* to_link =
      add_verb(*admin, "sign-in-link", "Create a link that signs a user in once, within 15 minutes",
               *options);
  to_link->add_option("user", options->user, "User name")->type_name("NAME")->required();
  program.on(*to_link, [options] { return link(*options); });

  CLI::App* to_set_aside = add_verb(
      *admin, "set-aside",
      "Set a damaged database aside; the daemon, which must be stopped, then starts with an "
      "empty one",
      *options);
  program.on(*to_set_aside, [options] { return become(arguments_of("set-aside", *options)); });

  CLI::App* to_check = add_verb(*admin, "check",
                                "Check whether the daemon can run workers, on a cluster too, and "
                                "whether its database or files "
                                "are damaged; the daemon may be running",
                                *options);
  to_check
      ->add_option("--config", options->config_file,
                   "The daemon's configuration; default: /etc/hydroprint/hydroprintd.toml, or "
                   "built-in settings if it does not exist")
      ->type_name("FILE");
  to_check->footer(
      "Prints a line for each thing: ok, note or FAULT. The exit status is 4 if there is a "
      "fault.\nExample:\n  sudo -u hydroprint hydroprint admin check --state-dir "
      "/var/lib/hydroprint");
  program.on(*to_check, [options] { return check(*options); });
}

}  // namespace hydroprint::cli
