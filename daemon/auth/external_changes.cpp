#include "daemon/auth/external_changes.h"

#include <chrono>

#include "daemon/auth/secret.h"

namespace hydroprint::auth {
namespace {

constexpr std::chrono::milliseconds kLookEvery{250};
constexpr std::chrono::seconds kAnswerWithin{10};
constexpr const char* kAsked = "people_changed";
constexpr const char* kRead = "people_read";

Result<std::string> setting(daemon::Database& database, const char* name) {
  std::string value;
  HP_RETURN_IF_ERROR(database.each("SELECT value FROM settings WHERE name=?", {std::string(name)},
                                   [&](const daemon::DbRow& row) { value = row.text(0); }));
  return value;
}

Status set(daemon::Database& database, const char* name, const std::string& value) {
  return database.run("INSERT OR REPLACE INTO settings VALUES (?,?)", {std::string(name), value});
}

}  // namespace

Result<std::string> tell_daemon(daemon::Database& database) {
  std::string word = random_hex(8);
  HP_RETURN_IF_ERROR(set(database, kAsked, word));
  return word;
}

Status wait_for_daemon(daemon::Database& database, const std::string& word) {
  const auto until = std::chrono::steady_clock::now() + kAnswerWithin;
  do {
    HP_ASSIGN_OR_RETURN(const std::string read, setting(database, kRead));
    if (read == word) return {};
    std::this_thread::sleep_for(kLookEvery / 5);
  } while (std::chrono::steady_clock::now() < until);
  return fail(Code::kUnavailable,
              "the change is stored, but the running daemon has not read it; restart the daemon to "
              "apply it");
}

ExternalChanges::ExternalChanges(daemon::Database& database, Accounts& accounts)
    : database_(database), accounts_(accounts), thread_(kLookEvery, [this] {
        (void)look();  // a failure is retried
      }) {}

Status ExternalChanges::look() {
  HP_ASSIGN_OR_RETURN(const std::string asked, setting(database_, kAsked));
  HP_ASSIGN_OR_RETURN(const std::string read, setting(database_, kRead));
  if (asked == read) return {};
  HP_RETURN_IF_ERROR(accounts_.reload());
  return set(database_, kRead, asked);
}

}  // namespace hydroprint::auth
