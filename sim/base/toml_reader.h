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

/// Reads a TOML file of at most 1 MiB. Include in .cpp files only.
/// Fails as read_text_file() does, and with kInvalidArgument, naming the line, if the file is not
/// valid TOML. Every error message is one line, whatever the file contains.
[[nodiscard]] Result<toml::table> read_toml_file(const std::filesystem::path& path);

/// Takes values out of a TOML file and refuses all other keys. It keeps the first error, with file,
/// line, key and remedy; values read after an error have no meaning. Read every value, then call
/// finish(). Copies refer to the same file. Include in .cpp files only.
class TomlReader {
 public:
  [[nodiscard]] static Result<TomlReader> open(const std::filesystem::path& path);

  [[nodiscard]] bool has(std::string_view key) const;

  /// The value of a key; a missing key is refused unless there is a `fallback`.
  double number(std::string_view key, double least, double most,
                std::optional<double> fallback = {});
  std::int64_t integer(std::string_view key, std::int64_t least, std::int64_t most,
                       std::optional<std::int64_t> fallback = {});
  bool flag(std::string_view key, std::optional<bool> fallback = {});
  std::string text(std::string_view key, std::optional<std::string> fallback = {});

  /// The index in `words` of a text that must be one of them.
  std::size_t choice(std::string_view key, const std::vector<std::string_view>& words,
                     std::optional<std::size_t> fallback = {});

  /// A table, or an array of tables with at least one; empty if the key is missing.
  TomlReader table(std::string_view key);
  std::vector<TomlReader> tables(std::string_view key);

  /// The entries of an array, for callers that check their contents.
  std::vector<const toml::node*> array(std::string_view key);

  /// A list of as many numbers as `out` has; leaves `out` unchanged if the key is missing.
  void vector(std::string_view key, double least, double most, Eigen::Ref<Eigen::VectorXd> out);
  /// Same as above, for a list within the value of `key`.
  void vector(std::string_view key, const toml::node& list, double least, double most,
              Eigen::Ref<Eigen::VectorXd> out);

  /// Records the error "KEY what" for `key` (or the table itself), unless there is an earlier
  /// error.
  void refuse(std::string_view key, const std::string& what);

  /// The first error; otherwise an error for the first key that was not read.
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
