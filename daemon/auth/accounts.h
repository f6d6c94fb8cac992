#pragma once

#include <memory>

#include "daemon/auth/api_keys.h"
#include "daemon/auth/sessions.h"
#include "daemon/auth/users.h"

namespace hydroprint::auth {

struct AccountsOptions {
  PasswordCost password_cost;
  SessionOptions sessions;
  std::size_t most_keys = 100;  ///< maximum number of API keys per user
};

/// Users, their API keys and sessions. They are rows of the store, with a copy in memory, so
/// identifying a caller never waits for the disk. Thread-safe.
class Accounts {
 public:
  /// Reads all rows.
  [[nodiscard]] static Result<std::unique_ptr<Accounts>> open(daemon::Database& database,
                                                              const AccountsOptions& options,
                                                              const daemon::Clock& clock);
  /// Stores when keys and sessions were last used.
  ~Accounts();
  Accounts(const Accounts&) = delete;
  Accounts& operator=(const Accounts&) = delete;

  [[nodiscard]] Users& users() { return users_; }
  [[nodiscard]] ApiKeys& keys() { return keys_; }
  [[nodiscard]] Sessions& sessions() { return sessions_; }

  /// Returns whether an active admin can sign in: with a password, an API key that has the role
  /// admin, an unused link or a session. Reads the store.
  [[nodiscard]] Result<bool> has_admin_who_can_sign_in();
  /// Reads the changes made by another program (external_changes.h).
  [[nodiscard]] Status reload() { return rows_.load(); }
  /// Deletes expired entries, and stores when keys and sessions were last used.
  [[nodiscard]] Status clean_up();

 private:
  Accounts(daemon::Database& database, const AccountsOptions& options, const daemon::Clock& clock);

  daemon::Clock clock_;
  AccountRows rows_;
  Passwords passwords_;
  Users users_;
  ApiKeys keys_;
  Sessions sessions_;
};

}  // namespace hydroprint::auth
