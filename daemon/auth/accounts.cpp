#include "daemon/auth/accounts.h"

#include <algorithm>
#include <set>

#include "daemon/auth/secret.h"

namespace hydroprint::auth {

Accounts::Accounts(daemon::Database& database, const AccountsOptions& options,
                   const daemon::Clock& clock)
    : clock_(clock),
      rows_(database),
      passwords_(options.password_cost),
      users_(rows_, passwords_, clock),
      keys_(rows_, users_, options.most_keys, clock),
      sessions_(rows_, users_, passwords_, options.sessions, clock) {}

Accounts::~Accounts() { (void)clean_up(); }

Result<std::unique_ptr<Accounts>> Accounts::open(daemon::Database& database,
                                                 const AccountsOptions& options,
                                                 const daemon::Clock& clock) {
  HP_RETURN_IF_ERROR(start_cryptography());
  std::unique_ptr<Accounts> accounts(new Accounts(database, options, clock));
  HP_RETURN_IF_ERROR(accounts->reload());
  return accounts;
}

Result<bool> Accounts::has_admin_who_can_sign_in() {
  std::set<std::string> linked;
  HP_RETURN_IF_ERROR(
      rows_.database.each("SELECT user FROM sign_in_links WHERE expire_ms>?", {clock_()},
                          [&](const daemon::DbRow& row) { linked.insert(row.text(0)); }));
  const std::lock_guard lock(rows_.memory);
  const auto is_admin = [&](const std::string& name) {
    const User* const user = rows_.admitted(name);
    return user != nullptr && user->role == Role::kAdmin;
  };
  const std::int64_t now_ms = clock_();
  return std::any_of(rows_.users.begin(), rows_.users.end(),
                     [&](const auto& entry) {
                       const bool is_let_in =
                           !entry.second.password.empty() || linked.contains(entry.first);
                       return is_let_in && is_admin(entry.first);
                     }) ||
         std::any_of(rows_.keys.begin(), rows_.keys.end(),
                     [&](const auto& entry) {
                       const ApiKey& key = entry.second;
                       const bool holds_still = key.expire_ms == 0 || key.expire_ms > now_ms;
                       return holds_still && key.role == Role::kAdmin && is_admin(key.user);
                     }) ||
         std::any_of(rows_.sessions.begin(), rows_.sessions.end(), [&](const auto& entry) {
           return sessions_.is_valid(entry.second) && is_admin(entry.second.user);
         });
}

Status Accounts::clean_up() {
  const std::lock_guard writing(rows_.writing);
  HP_RETURN_IF_ERROR(sessions_.end_expired());
  std::map<std::string, ApiKey> keys;
  std::unordered_map<std::string, Session> sessions;
  {
    const std::lock_guard lock(rows_.memory);
    keys = rows_.keys;
    sessions = rows_.sessions;
  }
  return rows_.database.transaction([&]() -> Status {
    HP_RETURN_IF_ERROR(
        rows_.database.run("DELETE FROM sign_in_links WHERE expire_ms<=?", {clock_()}));
    for (const auto& [hash, session] : sessions) {
      HP_RETURN_IF_ERROR(
          rows_.database.run("UPDATE sessions SET use_ms=?1 WHERE id=?2 AND use_ms<>?1",
                             {session.use_ms, session.id}));
    }
    for (const auto& [id, key] : keys) {
      HP_RETURN_IF_ERROR(rows_.database.run(
          "UPDATE api_keys SET use_ms=?1 WHERE id=?2 AND use_ms<>?1", {key.use_ms, id}));
    }
    return {};
  });
}

}  // namespace hydroprint::auth
