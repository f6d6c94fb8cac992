#pragma once

#include <map>
#include <mutex>
#include <string>
#include <unordered_map>

#include "daemon/auth/account.h"
#include "daemon/store/database/database.h"

namespace hydroprint::auth {

/// The rows of users, API keys and sessions, with a copy in memory, so identifying a caller never
/// waits for the disk. Shared by Users, ApiKeys and Sessions.
struct AccountRows {
  explicit AccountRows(daemon::Database& d) : database(d) {}

  /// Reads all rows.
  [[nodiscard]] Status load();
  /// Returns the user with that name; null for an unknown or disabled user. The caller must hold
  /// `memory`.
  [[nodiscard]] const User* admitted(const std::string& name) const;

  daemon::Database& database;
  std::recursive_mutex writing;  // held while rows change; never needed to identify a caller
  std::mutex memory;             // protects the members below; held only briefly
  std::map<std::string, User> users;
  std::map<std::string, ApiKey> keys;                 // by id
  std::unordered_map<std::string, Session> sessions;  // by token hash
};

}  // namespace hydroprint::auth
