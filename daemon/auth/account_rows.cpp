#include "daemon/auth/account_rows.h"

#include <algorithm>
#include <utility>

namespace hydroprint::auth {
namespace {

User read_user(const daemon::DbRow& row) {
  return {row.text(0), static_cast<Role>(row.integer(1)), row.integer(2) != 0, row.text(3),
          row.integer(4)};
}

ApiKey read_key(const daemon::DbRow& row) {
  return {
      row.text(0),    row.text(1),    row.text(2),   row.text(3), static_cast<Role>(row.integer(4)),
      row.integer(5), row.integer(6), row.integer(7)};
}

Session read_session(const daemon::DbRow& row) {
  return {row.text(0), row.text(1), row.text(2), row.text(3), row.integer(4), row.integer(5)};
}

}  // namespace

// Callers can be identified while the rows are read. The times of last use in memory are kept if
// they are newer than those in the rows.
Status AccountRows::load() {
  const std::lock_guard write_lock(writing);
  std::map<std::string, User> new_users;
  std::map<std::string, ApiKey> new_keys;
  std::unordered_map<std::string, Session> new_sessions;
  const Status read = database.transaction([&]() -> Status {
    HP_RETURN_IF_ERROR(database.each("SELECT name, role, disabled, password, create_ms FROM users",
                                     {}, [&](const daemon::DbRow& row) {
                                       User user = read_user(row);
                                       new_users[user.name] = std::move(user);
                                     }));
    HP_RETURN_IF_ERROR(database.each(
        "SELECT id, user, display_name, secret_hash, role, create_ms, expire_ms, use_ms FROM "
        "api_keys",
        {}, [&](const daemon::DbRow& row) {
          ApiKey key = read_key(row);
          new_keys[key.id] = std::move(key);
        }));
    return database.each("SELECT id, user, token_hash, peer, create_ms, use_ms FROM sessions", {},
                         [&](const daemon::DbRow& row) {
                           Session session = read_session(row);
                           new_sessions[session.token_hash] = std::move(session);
                         });
  });
  HP_RETURN_IF_ERROR(read);
  const std::lock_guard lock(memory);
  for (auto& [id, key] : new_keys) {
    if (const auto known = keys.find(id); known != keys.end()) {
      key.use_ms = std::max(key.use_ms, known->second.use_ms);
    }
  }
  for (auto& [hash, session] : new_sessions) {
    if (const auto known = sessions.find(hash); known != sessions.end()) {
      session.use_ms = std::max(session.use_ms, known->second.use_ms);
    }
  }
  users = std::move(new_users);
  keys = std::move(new_keys);
  sessions = std::move(new_sessions);
  return {};
}

const User* AccountRows::admitted(const std::string& name) const {
  const auto found = users.find(name);
  return found == users.end() || found->second.disabled ? nullptr : &found->second;
}

}  // namespace hydroprint::auth
