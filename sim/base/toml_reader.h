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

/// Reads a TOML file of at most 1 MiB. Include in .cpp files only. Returns the errors of
/// read_text_file(), and kInvalidArgument with the line if the file is not valid TOML. Error
/// messages are always one line, whatever the file contains.
[[nodiscard]] Result<toml::table> read_toml_file(const std::filesystem::path& path);

/// Reads values from a TOML file and rejects all other keys. The reader keeps the first error, with
/// file, line, key and remedy; values read after an error are meaningless. Read every value, then
/// call finish(). Copies refer to the same file. Include in .cpp files only.
class TomlReader {
 public:
  [[nodiscard]] static Result<TomlReader> open(const std::filesystem::path& path);

  [[nodiscard]] bool has(std::string_view key) const;

  /// Returns the value of a key. A missing key is an error unless there is a `fallback`.
  double number(std::string_view key, double least, double most,
                std::optional<double> fallback = {});
  std::int64_t integer(std::string_view key, std::int64_t least, std::int64_t most,
                       std::optional<std::int64_t> fallback = {});
  bool flag(std::string_view key, std::optional<bool> fallback = {});
  std::string text(std::string_view key, std::optional<std::string> fallback = {});

  /// Reads a text that must be one of `words` and returns its index.
  std::size_t choice(std::string_view key, const std::vector<std::string_view>& words,
                     std::optional<std::size_t> fallback = {});

  /// Returns a table, or the tables of an array. A missing key is an error; the result is then
  /// empty.
  TomlReader table(std::string_view key);
  std::vector<TomlReader> tables(std::string_view key);

  /// Returns the entries of an array, for callers that check the contents themselves.
  std::vector<const toml::node*> array(std::string_view key);

  /// Reads a list with exactly as many numbers as `out` has; `out` is unchanged if the key is
  /// missing.
  void vector(std::string_view key, double least, double most, Eigen::Ref<Eigen::VectorXd> out);
  /// Same as above, for a list within the value of `key`.
  void vector(std::string_view key, const toml::node& list, double least, double most,
              Eigen::Ref<Eigen::VectorXd> out);

  /// Records the error "KEY what" for `key` (or the table itself) unless an error was recorded
  /// before.
  void refuse(std::string_view key, const std::string& what);

  /// Returns the first error; if there is none, an error for the first key that was not read.
  [[nodiscard]] Status finish() const;

 private:
  struct Shared;
  TomlReader(std::shared_ptr<Shared> shared, const toml::table* table, std::string name);
  const toml::node* find(std::string_view key, bool required);
  [[nodiscard]] std::string full(std::string_view key) const;

  std::shared_ptr<Shared> shared_;
  const toml::table* table_;
  std::string name_;  // "watchdog.time"; empty at the top level
};

}  // namespace hydroprint
