#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <variant>

#include "sim/base/result.h"

namespace hydroprint::daemon {

/// A value bound to a statement: NULL, whole number, real, or bytes.
using DbValue = std::variant<std::monostate, std::int64_t, double, std::string>;

/// One row of an answer, valid during the call that hands it over.
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

/// One SQLite file, in WAL mode and synchronous=FULL: what a transaction wrote is on disk when it
/// returns. Any thread may call; calls take turns, and a transaction is one turn.
class Database {
 public:
  /// Opens or makes the file and gives it `schema` (statements that may be run again).
  /// @return kInternal, STORE_FAILED if it is no database or cannot be used
  [[nodiscard]] static Result<std::unique_ptr<Database>> open(const std::filesystem::path& path,
                                                              const char* schema);
  ~Database();
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  /// Runs one statement. A full disk is kResourceExhausted, DISK_FULL; else kInternal,
  /// STORE_FAILED.
  [[nodiscard]] Status run(const std::string& sql, std::initializer_list<DbValue> values = {});

  /// Runs one statement and hands over each row.
  [[nodiscard]] Status each(const std::string& sql, std::initializer_list<DbValue> values,
                            const std::function<void(const DbRow&)>& row);

  /// Runs `body` as one transaction: all of it stays, or none if it returns an error.
  [[nodiscard]] Status transaction(const std::function<Status()>& body);

  /// Key of the row inserted last; within a transaction only.
  [[nodiscard]] std::int64_t last_id() const;
  /// Rows the last statement changed; within a transaction only.
  [[nodiscard]] std::int64_t changes() const;

 private:
  Database();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydroprint::daemon
