#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "daemon/auth/account_rows.h"
#include "daemon/auth/password.h"
#include "daemon/platform/clock.h"

namespace hydroprint::auth {

/// Changes to a user.
struct UserChange {
  std::optional<Role> role;
  std::optional<bool> disabled;
};

/// Creates, changes and deletes users. Thread-safe.
///
/// Methods that take a user's name return kNotFound, USER_NOT_FOUND for an unknown name, and the
/// disk errors of Database::run().
class Users {
 public:
  Users(AccountRows& rows, Passwords& passwords, daemon::Clock clock)
      : rows_(rows), passwords_(passwords), clock_(std::move(clock)) {}

  /// Returns whether there are any users.
  [[nodiscard]] bool any() const;
  [[nodiscard]] Result<User> get(const std::string& name) const;
  /// Returns the users whose names follow `after`, sorted by name.
  [[nodiscard]] std::vector<User> list(const std::string& after, std::size_t limit) const;
  /// Creates a user.
  /// @param password  empty: the user cannot sign in with a password
  /// @param returns  whether this is the former user of that name, who may use the data stored
  /// under it again
  /// @return USER_EXISTS; SPEC_INVALID; LAST_ADMIN if the first user is not an admin;
  /// kFailedPrecondition, USER_NAME_USED if jobs, assets, calibrations or the audit log still refer
  /// to a deleted user of that name
  [[nodiscard]] Result<User> create(const User& user, const std::string& password,
                                    bool returns = false);
  /// Changes a user. Errors: LAST_ADMIN.
  [[nodiscard]] Result<User> update(const std::string& name, const UserChange& change);
  /// Sets a password and ends all sessions of the user except the one with id `spared`.
  /// @param password  empty: removes the password
  [[nodiscard]] Result<User> set_password(const std::string& name, const std::string& password,
                                          const std::string& spared);
  /// Deletes a user together with the user's keys and sessions. Errors: LAST_ADMIN.
  [[nodiscard]] Status remove(const std::string& name);

 private:
  [[nodiscard]] Status check_admin_without(const std::string& name, const User* instead) const;
  [[nodiscard]] Status check_name_is_free(const std::string& name);
  [[nodiscard]] Status write(const User& user);
  [[nodiscard]] Result<User> changed(const std::string& name,
                                     const std::function<void(User&)>& change);

  AccountRows& rows_;
  Passwords& passwords_;
  daemon::Clock clock_;
};

/// Returns SPEC_INVALID for an invalid user name (ID_INVALID if `field` is "name").
[[nodiscard]] Status check_user_name(const std::string& field, const std::string& name);

}  // namespace hydroprint::auth
