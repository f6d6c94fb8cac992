#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "client/cli/commands/commands.h"
#include "client/cli/program/program.h"

namespace hydroprint::cli {
namespace {

// Returns the subcommand with that name; null if there is none.
const CLI::App* child_of(const CLI::App& app, const std::string& name) {
  const auto has_name = [&](const CLI::App* child) { return child->check_name(name); };
  const auto found = app.get_subcommands(has_name);
  return found.empty() ? nullptr : found.front();
}

Status help(const CLI::App& app, const std::vector<std::string>& words) {
  const CLI::App* command = &app;
  for (const std::string& word : words) {
    command = child_of(*command, word);
    if (command == nullptr)
      return fail(Code::kInvalidArgument,
                  "help: unknown command '" + word + "'; see hydroprint --help");
  }
  // CLI::App::help() would describe this command, which is the one on the command line.
  std::cout << command->get_formatter()->make_help(command, command->get_name(),
                                                   CLI::AppFormatMode::Normal);
  return {};
}

}  // namespace

void add_help(CLI::App& app, Program& program) {
  auto words = std::make_shared<std::vector<std::string>>();
  CLI::App* command = app.add_subcommand("help", "Show the help of a command");
  command->add_option("command", *words, "The command; default: all of hydroprint")
      ->type_name("COMMAND");
  command->footer("Example:\n  hydroprint help submit simulate");
  program.on(*command, [&app, words] { return help(app, *words); });
}

}  // namespace hydroprint::cli
