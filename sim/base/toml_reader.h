#pragma once

#include <toml++/toml.h>

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/base/result.h"

namespace hydroprint {

/// Reads a TOML file of at most 1 MiB. For inclusion in .cpp files only.
/// Refuses what read_text_file refuses, and with kInvalidArgument what is no TOML, naming the line.
/// Every refusal from here is one line, whatever the file holds.
[[nodiscard]] Result<toml::table> read_toml_file(const std::filesystem::path& path);

/// Takes values out of a TOML file that may hold nothing else. The first thing wrong is kept, by
/// file, line, key and remedy; what is asked for after it gives values that mean nothing. So: ask
/// for everything, then finish(). Copies speak of the same file. For inclusion in .cpp files only.
class TomlReader {
 public:
  [[nodiscard]] static Result<TomlReader> open(const std::filesystem::path& path);

  [[nodiscard]] bool has(std::string_view key) const;

  /// Values of a key; a key that is absent is refused unless there is a `fallback`.
  double number(std::string_view key, double least, double most,
                std::optional<double> fallback = {});
  std::int64_t integer(std::string_view key, std::int64_t least, std::int64_t most,
                       std::optional<std::int64_t> fallback = {});
  bool flag(std::string_view key, std::optional<bool> fallback = {});
  std::string text(std::string_view key, std::optional<std::string> fallback = {});

  /// A text that must be one of `words`; its index.
  std::size_t choice(std::string_view key, const std::vector<std::string_view>& words,
                     std::optional<std::size_t> fallback = {});

  /// A table, and an array of tables with at least one; empty ones where there is none.
  TomlReader table(std::string_view key);
  std::vector<TomlReader> tables(std::string_view key);

  /// The entries of an array, for those who know more of them.
  std::vector<const toml::node*> array(std::string_view key);

  /// A list of as many numbers as `out` has; that is left as it is where the key is absent.
  void vector(std::string_view key, double least, double most, Eigen::Ref<Eigen::VectorXd> out);
  /// The same of a list within the value of `key`.
  void vector(std::string_view key, const toml::node& list, double least, double most,
              Eigen::Ref<Eigen::VectorXd> out);

  /// Keeps, unless something was wrong before, that `key` (or the table itself) is wrong: "what".
  void refuse(std::string_view key, const std::string& what);

  /// The first thing that was wrong; otherwise the first key that nobody asked for.
  [[nodiscard]] Status finish() const;

 private:
  struct Shared;
  TomlReader(std::shared_ptr<Shared> shared, const toml::table* table, std::string name);
  const toml::node* find(std::string_view key, bool required);
  [[nodiscard]] std::string full(std::string_view key) const;

  std::shared_ptr<Shared> shared_;
  const toml::table* table_;
  std::string name_;  // "watchdog.time"; empty at the top
};

}  // namespace hydroprint
