#include "client/cli/program/usage.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "client/cli/terminal/console.h"

namespace hydroprint::cli {
namespace {

// Returns the number of edits that turn `a` into `b`: letters inserted, deleted, replaced, or
// swapped with the next letter.
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> last, row(b.size() + 1), next(b.size() + 1);
  std::iota(row.begin(), row.end(), 0U);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    next[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      next[j] =
          std::min({row[j] + 1, next[j - 1] + 1, row[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        next[j] = std::min(next[j], last[j - 2] + 1);
    }
    last = row;
    row.swap(next);
  }
  return row.back();
}

// Returns the most similar known word; empty if even that one needs edits of more than a third of
// the letters of `word`. One edit is always allowed.
std::string nearest(const std::string& word, const std::vector<std::string>& known) {
  std::string found;
  std::size_t least = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string& other : known) {
    if (const std::size_t apart = distance(word, other); apart < least) {
      least = apart;
      found = other;
    }
  }
  return found;
}

std::vector<std::string> commands_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* child : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(child->get_name());
  return names;
}

// Returns the long flags of a command and its parents.
std::vector<std::string> flags_of(const CLI::App* app) {
  std::vector<std::string> names;
  for (; app != nullptr; app = app->get_parent())
    for (const CLI::Option* option : app->get_options())
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

// Describes the first word that was not understood, and suggests a similar command or flag. Returns
// an empty text if all words were understood, or if `app` has no commands and the word is not a
// flag.
std::string unknown_word(const CLI::App& app, const std::vector<std::string>& words) {
  if (words.empty()) return "";
  const bool is_flag = words.front().starts_with("-");
  const auto known = is_flag ? flags_of(&app) : commands_of(app);
  if (known.empty()) return "";
  const std::string word =
      is_flag ? words.front().substr(0, words.front().find('=')) : words.front();
  const std::string similar = nearest(word, known);
  return fmt::format("unknown {} '{}'{}", is_flag ? "flag" : "command", word,
                     similar.empty() ? "" : fmt::format("; did you mean '{}'?", similar));
}

const CLI::App& chosen_command(const CLI::App& app) {
  const CLI::App* command = &app;
  for (auto chosen = app.get_subcommands(); !chosen.empty(); chosen = command->get_subcommands())
    command = chosen.front();
  return *command;
}

}  // namespace

std::string full_name(const CLI::App& app) {
  return (app.get_parent() != nullptr ? full_name(*app.get_parent()) + " " : "") + app.get_name();
}

std::string usage_error(const CLI::App* app, const CLI::Error& error) {
  const auto code = static_cast<CLI::ExitCodes>(error.get_exit_code());
  const bool is_unknown =
      code == CLI::ExitCodes::ExtrasError || code == CLI::ExitCodes::RequiredError;
  const auto words = is_unknown ? app->remaining(true) : std::vector<std::string>();
  app = &chosen_command(*app);
  std::string what = unknown_word(*app, words);
  if (what.empty()) what = error.what();
  const char* const link = what.ends_with("?") ? " See " : "; see ";
  return fmt::format("hydroprint: {}{}{} --help\n", printable(what), link, full_name(*app));
}

std::string word_of_field(const CLI::App& app, const std::string& field) {
  std::string flag = "--" + field.substr(field.rfind('.') + 1);
  std::replace(flag.begin(), flag.end(), '_', '-');
  return chosen_command(app).get_option_no_throw(flag) == nullptr ? field : flag;
}

}  // namespace hydroprint::cli
