#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/auth/users.h"

namespace hydroprint::auth {

/// Fields of a key to create.
struct NewKey {
  std::string user;
  std::string display_name;
  Role role = Role::kViewer;
  std::int64_t ttl_ms = 0;  ///< 0: never expires
};

/// The API keys of users. Their secrets are stored hashed. Thread-safe.
class ApiKeys {
 public:
  /// @param most  maximum number of keys per user
  ApiKeys(AccountRows& rows, const Users& users, std::size_t most, daemon::Clock clock)
      : rows_(rows), users_(users), most_(most), clock_(std::move(clock)) {}

  /// Returns the caller with this key ("hp_ID_SECRET"); nullopt if the key is not valid. Never
  /// waits.
  /// @param is_use  whether this counts as a use of the key
  [[nodiscard]] std::optional<Caller> caller(std::string_view key, bool is_use = true);
  /// Creates a key and returns it with "hp_ID_SECRET", which is shown only once.
  /// Errors: KEYS_FULL, SPEC_INVALID, USER_NOT_FOUND.
  [[nodiscard]] Result<std::pair<ApiKey, std::string>> create(const NewKey& fields);
  /// Returns the keys of a user with ids after `after`, sorted by id; those of all users if `user`
  /// is empty.
  [[nodiscard]] std::vector<ApiKey> list(const std::string& user, const std::string& after,
                                         std::size_t limit) const;
  /// Returns the key with this id. Errors: KEY_NOT_FOUND.
  [[nodiscard]] Result<ApiKey> get(const std::string& id) const;
  /// Deletes a key; no error if it does not exist.
  [[nodiscard]] Status remove(const std::string& id);

 private:
  AccountRows& rows_;
  const Users& users_;
  std::size_t most_;
  daemon::Clock clock_;
};

}  // namespace hydroprint::auth
