#include "daemon/store/database/database.h"

#include <sqlite3.h>

#include <cerrno>
#include <mutex>
#include <unordered_map>

namespace hydroprint::daemon {
namespace {

constexpr int kPatience_ms = 5000;  // for other processes that use the file

struct CloseStatement {
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Statement = std::unique_ptr<sqlite3_stmt, CloseStatement>;

sqlite3_stmt* as_statement(void* statement) { return static_cast<sqlite3_stmt*>(statement); }

// Returns whether the disk is full. SQLite reports "full" if a write finds no space, but not if
// extending or syncing a file fails.
bool disk_is_full(sqlite3* db) {
  const int code = sqlite3_errcode(db), error = sqlite3_system_errno(db);
  return code == SQLITE_FULL || ((code == SQLITE_IOERR || code == SQLITE_CANTOPEN) &&
                                 (error == ENOSPC || error == EDQUOT));
}

tl::unexpected<Error> damaged(const std::string& what) {
  return fail(Code::kInternal,
              "the job database is damaged (" + what +
                  "); stop the daemon, then restore a backup (hydroprint admin restore --replace "
                  "FILE), or set the database aside and start with an empty one (hydroprint admin "
                  "set-aside)",
              ErrorReason::STORE_FAILED);
}

tl::unexpected<Error> database_failure(sqlite3* db) {
  const int code = sqlite3_errcode(db);
  if (code == SQLITE_CORRUPT || code == SQLITE_NOTADB) return damaged(sqlite3_errmsg(db));
  if (disk_is_full(db)) {
    return fail(Code::kResourceExhausted,
                "the daemon's disk is full; delete jobs or assets, or free disk space",
                ErrorReason::DISK_FULL);
  }
  return fail(Code::kInternal,
              std::string("the job database cannot be used: ") + sqlite3_errmsg(db) +
                  "; check the state folder's disk and permissions",
              ErrorReason::STORE_FAILED);
}

// Returns a failure of the file at `path`.
tl::unexpected<Error> failure_of(const std::filesystem::path& path, tl::unexpected<Error> failure) {
  failure.value().message = path.string() + ": " + failure.value().message;
  return failure;
}

// Copies the write-ahead log to the database, so that the log starts again and does not need to
// grow. A change that failed because the disk was full may then succeed. A failure to copy does no
// harm.
void empty_log(sqlite3* db) {
  sqlite3_wal_checkpoint_v2(db, nullptr, SQLITE_CHECKPOINT_RESTART, nullptr, nullptr);
}

// Reserves empty pages in the file and space in its log. They are needed to store the end of a job
// when the disk is full. A failure to reserve them does no harm.
void keep_room(sqlite3* db) {
  sqlite3_exec(db,
               "BEGIN IMMEDIATE; CREATE TABLE kept_room(bytes BLOB); "
               "INSERT INTO kept_room VALUES (zeroblob(65536)); DROP TABLE kept_room; COMMIT;",
               nullptr, nullptr, nullptr);
  if (sqlite3_get_autocommit(db) == 0) sqlite3_exec(db, "ROLLBACK", nullptr, nullptr, nullptr);
}

int bind(sqlite3_stmt* statement, int index, const DbValue& value) {
  struct Binder {
    sqlite3_stmt* statement;
    int index;
    int operator()(std::monostate) const { return sqlite3_bind_null(statement, index); }
    int operator()(std::int64_t number) const {
      return sqlite3_bind_int64(statement, index, number);
    }
    int operator()(double number) const { return sqlite3_bind_double(statement, index, number); }
    int operator()(const std::string& text) const {
      return sqlite3_bind_text64(statement, index, text.data(), text.size(), SQLITE_TRANSIENT,
                                 SQLITE_UTF8);
    }
  };
  return std::visit(Binder{statement, index}, value);
}

}  // namespace

struct Database::Impl {
  ~Impl() {
    statements.clear();
    sqlite3_close(db);
  }
  Result<sqlite3_stmt*> prepared(const std::string& sql) {
    Statement& statement = statements[sql];
    if (!statement) {
      sqlite3_stmt* raw_statement = nullptr;
      if (sqlite3_prepare_v3(db, sql.c_str(), -1, SQLITE_PREPARE_PERSISTENT, &raw_statement,
                             nullptr) != SQLITE_OK) {
        return database_failure(db);
      }
      statement.reset(raw_statement);
    }
    return statement.get();
  }

  std::recursive_mutex mutex;  // held for a whole transaction
  sqlite3* db = nullptr;
  std::unordered_map<std::string, Statement> statements;
};

Database::Database() : impl_(std::make_unique<Impl>()) {}
Database::~Database() = default;

Result<std::unique_ptr<Database>> Database::open(const std::filesystem::path& path,
                                                 const char* schema) {
  std::unique_ptr<Database> database(new Database);
  sqlite3*& db = database->impl_->db;
  const std::string setup =
      "PRAGMA journal_mode=WAL; PRAGMA synchronous=FULL; PRAGMA foreign_keys=ON; "
      "PRAGMA temp_store=MEMORY; BEGIN IMMEDIATE; " +
      std::string(schema) + " COMMIT;";
  if (sqlite3_open_v2(path.c_str(), &db, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, nullptr) !=
          SQLITE_OK ||
      sqlite3_busy_timeout(db, kPatience_ms) != SQLITE_OK ||
      sqlite3_exec(db, setup.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) {
    return failure_of(path, database_failure(db));
  }
  keep_room(db);
  empty_log(db);
  return database;
}

Result<std::unique_ptr<Database>> Database::open_to_read(const std::filesystem::path& path) {
  std::unique_ptr<Database> database(new Database);
  sqlite3*& db = database->impl_->db;
  if (sqlite3_open_v2(path.c_str(), &db, SQLITE_OPEN_READONLY, nullptr) != SQLITE_OK ||
      sqlite3_busy_timeout(db, kPatience_ms) != SQLITE_OK) {
    return failure_of(path, database_failure(db));
  }
  return database;
}

Status Database::check(const std::filesystem::path& path) {
  HP_ASSIGN_OR_RETURN(const auto database, open_to_read(path));
  std::string verdict;
  const Status read =
      database->each("PRAGMA quick_check(1)", {}, [&](const DbRow& row) { verdict = row.text(0); });
  if (!read) return failure_of(path, tl::unexpected(read.error()));
  if (verdict == "ok") return {};
  // The first line only says "in database main".
  return failure_of(path, damaged(verdict.substr(verdict.find('\n') + 1)));
}

Status Database::each(const std::string& sql, std::initializer_list<DbValue> values,
                      const std::function<void(const DbRow&)>& row) {
  const std::lock_guard lock(impl_->mutex);
  HP_ASSIGN_OR_RETURN(sqlite3_stmt* const statement, impl_->prepared(sql));
  int index = 0;
  for (const DbValue& value : values) bind(statement, ++index, value);
  int code = sqlite3_step(statement);
  for (; code == SQLITE_ROW; code = sqlite3_step(statement)) row(DbRow(statement));
  Status status = code == SQLITE_DONE ? Status() : database_failure(impl_->db);
  sqlite3_reset(statement);
  sqlite3_clear_bindings(statement);
  return status;
}

Status Database::run(const std::string& sql, std::initializer_list<DbValue> values) {
  return each(sql, values, [](const DbRow&) {});
}

Status Database::transaction(const std::function<Status()>& body) {
  const std::lock_guard lock(impl_->mutex);
  HP_RETURN_IF_ERROR(run("BEGIN IMMEDIATE"));
  Status status = body();
  if (status) status = run("COMMIT");
  // A failed COMMIT may leave the transaction open; some errors have already rolled it back.
  if (!status && sqlite3_get_autocommit(impl_->db) == 0) (void)run("ROLLBACK");
  if (!status && status.error().reason == ErrorReason::DISK_FULL) empty_log(impl_->db);
  return status;
}

std::int64_t Database::last_id() const { return sqlite3_last_insert_rowid(impl_->db); }
std::int64_t Database::changes() const { return sqlite3_changes64(impl_->db); }

std::vector<std::string> Database::statements() const {
  const std::lock_guard lock(impl_->mutex);
  std::vector<std::string> all;
  all.reserve(impl_->statements.size());
  for (const auto& [sql, statement] : impl_->statements) all.push_back(sql);
  return all;
}

std::int64_t DbRow::integer(int column) const {
  return sqlite3_column_int64(as_statement(statement_), column);
}
double DbRow::real(int column) const {
  return sqlite3_column_double(as_statement(statement_), column);
}
std::string DbRow::text(int column) const {
  const auto* bytes =
      static_cast<const char*>(sqlite3_column_blob(as_statement(statement_), column));
  const int size = sqlite3_column_bytes(as_statement(statement_), column);
  return bytes == nullptr ? std::string() : std::string(bytes, static_cast<std::size_t>(size));
}
bool DbRow::is_null(int column) const {
  return sqlite3_column_type(as_statement(statement_), column) == SQLITE_NULL;
}

}  // namespace hydroprint::daemon
