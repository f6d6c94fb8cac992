#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "client/cli/commands/commands.h"
#include "client/cli/program/program.h"

namespace hydroprint::cli {
namespace {

// A flag, as needed for completion.
struct Flag {
  std::vector<std::string> names;  // "--out", "-h"
  std::string help;
  bool takes_value = false;
  bool takes_path = false;
  std::vector<std::string> choices;
};

// A command with all its flags, including those of its parent commands.
struct Command {
  std::string path;  // "hydroprint submit simulate"
  std::vector<std::string> words;
  std::vector<std::string> helps;  // help text of each word
  std::vector<Flag> flags;
  bool takes_file = false;           // its arguments are files
  std::vector<std::string> choices;  // the choices of its arguments; empty: any
};

// CLI11 keeps the choices of IsMember in the type's name, as "STATE:{A,B}".
std::vector<std::string> choices_of(const std::string& type) {
  const auto open = type.find('{');
  const auto close = type.rfind('}');
  if (open == std::string::npos || close == std::string::npos) return {};
  return CLI::detail::split(type.substr(open + 1, close - open - 1), ',');
}

bool is_path(const std::string& type) {
  return type.starts_with("FILE") || type.starts_with("DIR");
}

Flag describe(const CLI::Option& option) {
  Flag flag;
  for (const std::string& name : option.get_snames()) flag.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) flag.names.push_back("--" + name);
  flag.help = option.get_description();
  flag.takes_value = option.get_items_expected_max() > 0;
  flag.takes_path = is_path(option.get_type_name());
  flag.choices = choices_of(option.get_type_name());
  return flag;
}

void walk(const CLI::App& app, Command command, std::vector<Command>& commands) {
  command.path += (command.path.empty() ? "" : " ") + app.get_name();
  for (const CLI::Option* option : app.get_options()) {
    if (!option->get_positional()) {
      command.flags.push_back(describe(*option));
      continue;
    }
    const auto choices = choices_of(option->get_type_name());
    command.choices.insert(command.choices.end(), choices.begin(), choices.end());
    command.takes_file = command.takes_file || is_path(option->get_type_name());
  }
  Command below{command.path, {}, {}, command.flags, false, {}};
  std::erase_if(below.flags, [](const Flag& flag) {  // not inherited: --help is defined for every
                                                     // command, --version only for hydroprint
    return flag.names.back() == "--help" || flag.names.back() == "--version";
  });
  const auto children = app.get_subcommands([](const CLI::App*) { return true; });
  for (const CLI::App* child : children) {
    command.words.push_back(child->get_name());
    command.helps.push_back(child->get_description());
  }
  commands.push_back(std::move(command));
  for (const CLI::App* child : children) walk(*child, below, commands);
}

std::string join(const std::vector<std::string>& words, const char* separator = " ") {
  return CLI::detail::join(words, separator);
}

// Quotes a word for a shell.
std::string quote(const std::string& text) {
  std::string result = "'";
  for (const char c : text) c == '\'' ? result += "'\\''" : result += c;
  return result + "'";
}

std::string all_words(const Command& command) {
  std::vector<std::string> words = command.words;
  words.insert(words.end(), command.choices.begin(), command.choices.end());
  for (const Flag& flag : command.flags)
    words.insert(words.end(), flag.names.begin(), flag.names.end());
  return join(words);
}

// Returns the shell's case branches for the values of flags. Each matches "PATH FLAG" and suggests
// files, choices or nothing.
std::string value_cases(const Command& command, const std::string& files,
                        const std::string& before_choices, const std::string& after_choices) {
  std::string text;
  for (const Flag& flag : command.flags) {
    if (!flag.takes_value) continue;
    std::string action = ":";
    if (flag.takes_path) action = files;
    if (!flag.choices.empty()) action = before_choices + join(flag.choices) + after_choices;
    for (const std::string& name : flag.names)
      text += "    " + quote(command.path + " " + name) + ") " + action + "; return ;;\n";
  }
  return text;
}

// Returns a shell function that joins the command words so far, for example "hydroprint submit
// simulate"; flags and their values are skipped.
std::string path_function(const std::vector<Command>& commands, const char* name) {
  std::string cases;
  for (const Command& command : commands)
    for (const std::string& word : command.words)
      cases += std::string(cases.empty() ? "" : "|") + quote(command.path + " " + word);
  return std::string(name) + "() {\n  path=hydroprint\n  local word\n  for word in \"$@\"; do\n" +
         "    case \"$path $word\" in\n      " + cases + ") path=\"$path $word\" ;;\n" +
         "    esac\n  done\n}\n";
}

std::string bash_script(const std::vector<Command>& commands) {
  std::string values;
  std::string words;
  for (const Command& command : commands) {
    values += value_cases(command, "COMPREPLY=($(compgen -f -- \"$current\"))",
                          "COMPREPLY=($(compgen -W '", "' -- \"$current\"))");
    words += "    " + quote(command.path) + ") COMPREPLY=($(compgen " +
             (command.takes_file ? "-f " : "") + "-W " + quote(all_words(command)) +
             " -- \"$current\")) ;;\n";
  }
  return "# bash completion of hydroprint; to use it: source <(hydroprint completion bash)\n" +
         path_function(commands, "_hydroprint_path") +
         "_hydroprint() {\n  local path current=${COMP_WORDS[COMP_CWORD]}\n"
         "  COMPREPLY=()\n"
         "  _hydroprint_path \"${COMP_WORDS[@]:1:COMP_CWORD-1}\"\n"
         "  case \"$path ${COMP_WORDS[COMP_CWORD-1]}\" in\n" +
         values + "  esac\n  case \"$path\" in\n" + words +
         "  esac\n}\ncomplete -o filenames -o bashdefault -F _hydroprint hydroprint\n";
}

std::string zsh_script(const std::vector<Command>& commands) {
  std::string values;
  std::string words;
  for (const Command& command : commands) {
    values += value_cases(command, "_files", "compadd -- ", "");
    words += "    " + quote(command.path) + ") compadd -- " + all_words(command) +
             (command.takes_file ? "; _files" : "") + " ;;\n";
  }
  return "#compdef hydroprint\n# zsh completion of hydroprint; to use it: source <(hydroprint "
         "completion zsh)\n" +
         path_function(commands, "_hydroprint_path") +
         "_hydroprint() {\n  local path\n"
         "  _hydroprint_path \"${(@)words[2,CURRENT-1]}\"\n"
         "  case \"$path ${words[CURRENT-1]}\" in\n" +
         values + "  esac\n  case \"$path\" in\n" + words +
         "  esac\n}\ncompdef _hydroprint hydroprint\n";
}

std::string fish_flag(const Flag& flag) {
  std::string text;
  for (const std::string& name : flag.names)
    text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  if (flag.takes_value) text += flag.takes_path ? " -rF" : " -x";
  if (!flag.choices.empty()) text += " -a " + quote(join(flag.choices));
  return text + " -d " + quote(flag.help);
}

std::string fish_script(const std::vector<Command>& commands) {
  std::vector<std::string> known;
  for (const Command& command : commands)
    for (const std::string& word : command.words) known.push_back(quote(command.path + " " + word));
  std::string text =
      "# fish completion of hydroprint; to use it: hydroprint completion fish | source\n"
      "function __hydroprint_at\n  set -l path hydroprint\n"
      "  for word in (commandline -opc)[2..-1]\n"
      "    if contains -- \"$path $word\" " +
      join(known) +
      "\n      set path \"$path $word\"\n    end\n  end\n"
      "  test \"$path\" = \"$argv\"\nend\ncomplete -c hydroprint -f\n";
  for (const Command& command : commands) {
    const std::string head =
        "complete -c hydroprint -n " + quote("__hydroprint_at " + command.path);
    for (std::size_t i = 0; i < command.words.size(); ++i)
      text += head + " -a " + command.words[i] + " -d " + quote(command.helps[i]) + "\n";
    if (command.takes_file) text += head + " -F\n";
    if (!command.choices.empty()) text += head + " -a " + quote(join(command.choices)) + "\n";
    for (const Flag& flag : command.flags) text += head + fish_flag(flag) + "\n";
  }
  return text;
}

Status completion(const CLI::App& app, const std::string& shell) {
  std::vector<Command> commands;
  walk(app, {}, commands);
  std::cout << (shell == "bash"  ? bash_script(commands)
                : shell == "zsh" ? zsh_script(commands)
                                 : fish_script(commands));
  return {};
}

}  // namespace

void add_completion(CLI::App& app, Program& program) {
  auto shell = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("completion", "Print a shell completion script");
  command->add_option("shell", *shell, "The shell")
      ->type_name("SHELL")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  command->footer(
      "Example:\n  hydroprint completion bash > "
      "~/.local/share/bash-completion/completions/hydroprint");
  program.on(*command, [&app, shell] { return completion(app, *shell); });
}

}  // namespace hydroprint::cli
