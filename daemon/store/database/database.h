#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "sim/base/result.h"

namespace hydroprint::daemon {

/// A value bound to a statement: NULL, integer, real, or bytes.
using DbValue = std::variant<std::monostate, std::int64_t, double, std::string>;

/// One row of a result, valid only during the callback of Database::each().
class DbRow {
 public:
  explicit DbRow(void* statement) : statement_(statement) {}
  [[nodiscard]] std::int64_t integer(int column) const;
  [[nodiscard]] double real(int column) const;
  [[nodiscard]] std::string text(int column) const;
  [[nodiscard]] bool is_null(int column) const;

 private:
  void* statement_;
};

/// An SQLite file, in WAL mode and synchronous=FULL: committed changes are on disk when the call
/// returns. Thread-safe; calls run one at a time, and a transaction counts as one call.
class Database {
 public:
  /// Opens or creates the file and runs the statements `schema` in one transaction.
  /// @return kInternal, STORE_FAILED if the file is not a database or cannot be used
  [[nodiscard]] static Result<std::unique_ptr<Database>> open(const std::filesystem::path& path,
                                                              const char* schema);
  /// Opens a file, which other connections may be using, to read it. Changes nothing, but empty
  /// files of SQLite may remain beside it.
  /// @return as open()
  [[nodiscard]] static Result<std::unique_ptr<Database>> open_to_read(
      const std::filesystem::path& path);
  /// Opens a file in the same way, reads all of it, and checks its structure with SQLite's
  /// quick_check.
  /// @return kInternal, STORE_FAILED if it is damaged or cannot be read
  [[nodiscard]] static Status check(const std::filesystem::path& path);
  ~Database();
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  /// Runs one statement. Errors: kResourceExhausted, DISK_FULL if the disk is full; otherwise
  /// kInternal, STORE_FAILED.
  [[nodiscard]] Status run(const std::string& sql, std::initializer_list<DbValue> values = {});

  /// Runs one statement and calls `row` for each row.
  [[nodiscard]] Status each(const std::string& sql, std::initializer_list<DbValue> values,
                            const std::function<void(const DbRow&)>& row);

  /// Runs `body` as one transaction; an error rolls all of it back.
  [[nodiscard]] Status transaction(const std::function<Status()>& body);

  /// Returns the key of the last inserted row. Call this only within a transaction.
  [[nodiscard]] std::int64_t last_id() const;
  /// Returns the number of rows that the last statement changed. Call this only within a
  /// transaction.
  [[nodiscard]] std::int64_t changes() const;
  /// Returns the SQL of all statements that have run, for tests of their plans.
  [[nodiscard]] std::vector<std::string> statements() const;

 private:
  Database();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydroprint::daemon
