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

// What is done on the daemon's own machine, to its state folder, is done by its own program:
// hydroprintd admin. Here are its command line and the questions that are asked on a terminal.
namespace hydroprint::cli {
namespace {

struct AdminOptions {
  std::string state_dir, file, user;
  bool from_stdin = false;  // which is what is read where it is no terminal, with or without this
  bool replace = false;
};

// Beside this program, or else wherever it is found.
std::string daemon_program() {
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  const auto beside = self.parent_path() / "hydroprintd";
  return !error && std::filesystem::exists(beside, error) ? beside.string() : "hydroprintd";
}

// Becomes that program; comes back only if it cannot.
Status become(const std::vector<std::string>& arguments) {
  std::vector<std::string> words{daemon_program(), "admin"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> raw;
  raw.reserve(words.size() + 1);
  for (std::string& word : words) raw.push_back(word.data());
  raw.push_back(nullptr);
  ::execvp(raw.front(), raw.data());
  return fail(Code::kFailedPrecondition,
              words.front() + ": cannot be started: " + std::generic_category().message(errno) +
                  "; this is for the machine that hydroprintd is installed on");
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

// The password goes through a pipe, which holds it until the other program reads: it stands on no
// command line, and in no file.
Status reset_password(const AdminOptions& options) {
  HP_ASSIGN_OR_RETURN(const std::string password, ask_new_password());
  constexpr std::size_t kLongestPassword = 1000;  // a pipe takes as much at once
  if (password.size() > kLongestPassword) {
    return fail(Code::kInvalidArgument,
                "the password has more than 1000 bytes; take a shorter one");
  }
  int ends[2] = {-1, -1};
  const std::string line = password + "\n";
  if (::pipe(ends) != 0 || ::dup2(ends[0], STDIN_FILENO) < 0 ||
      ::write(ends[1], line.data(), line.size()) != static_cast<ssize_t>(line.size())) {
    return fail(Code::kInternal, "no pipe can be made: " + std::generic_category().message(errno));
  }
  ::close(ends[0]);
  ::close(ends[1]);
  std::vector<std::string> arguments = arguments_of("reset-password", options);
  arguments.insert(arguments.end(), {"--stdin", "--", options.user});
  return become(arguments);
}

CLI::App* add_verb(CLI::App& admin, const char* name, const char* help, AdminOptions& options) {
  CLI::App* const verb = admin.add_subcommand(name, help);
  verb->add_option("--state-dir", options.state_dir,
                   "The daemon's state folder; default: that of a daemon of yours")
      ->type_name("DIR");
  return verb;
}

}  // namespace

void add_admin(CLI::App& app, Program& program) {
  auto options = std::make_shared<AdminOptions>();
  CLI::App* admin = app.add_subcommand(
      "admin", "On the daemon's machine, as its user: back up and restore, let people in again");
  admin->require_subcommand(1);

  CLI::App* backup = add_verb(
      *admin, "backup", "Write all there is to one file, the daemon running or not", *options);
  backup->add_option("file", options->file, "The archive (tar), which must not be there yet")
      ->type_name("FILE")
      ->required();
  backup->footer(
      "Example:\n  sudo -u hydroprint hydroprint admin backup --state-dir "
      "/var/lib/hydroprint /backups/hydroprint-$(date +%F).tar");
  program.on(*backup, [options] { return on_file("backup", *options); });

  CLI::App* restore =
      add_verb(*admin, "restore", "Bring back what backup wrote, the daemon stopped", *options);
  restore->add_option("file", options->file, "The archive")->type_name("FILE")->required();
  restore->add_flag("--replace", options->replace, "Delete what is in the state folder");
  program.on(*restore, [options] { return on_file("restore", *options); });

  CLI::App* reset =
      add_verb(*admin, "reset-password", "Set a user's password, and end their sessions", *options);
  reset->add_option("user", options->user, "Whose")->type_name("NAME")->required();
  reset->add_flag("--stdin", options->from_stdin, "Read it from standard input");
  program.on(*reset, [options] { return reset_password(*options); });

  CLI::App* to_link =
      add_verb(*admin, "sign-in-link",
               "Make a link by which a user signs in once, within 15 minutes", *options);
  to_link->add_option("user", options->user, "Whose")->type_name("NAME")->required();
  program.on(*to_link, [options] { return link(*options); });
}

}  // namespace hydroprint::cli
