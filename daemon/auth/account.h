#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace hydroprint::auth {

/// Permission level; numbers and meanings as in hydroprint.v1.Role.
enum class Role : std::int8_t { kViewer = 1, kMaker = 2, kOperator = 3, kAdmin = 4 };

/// Returns the role's name, for example "OPERATOR".
[[nodiscard]] const char* name_of(Role role);

/// A person who may use the daemon. Times, here and below, are Unix times in ms.
struct User {
  std::string name;
  Role role = Role::kViewer;
  bool disabled = false;
  std::string password;  ///< result of Passwords::hash(); empty: no password
  std::int64_t create_ms = 0;
};

/// A key that lets scripts act as a user.
struct ApiKey {
  std::string id;
  std::string user;
  std::string display_name;
  std::string secret_hash;
  Role role = Role::kViewer;  ///< as granted; the user's own role applies if it is lower
  std::int64_t create_ms = 0;
  std::int64_t expire_ms = 0;  ///< 0: never
  std::int64_t use_ms = 0;     ///< 0: never used
};

/// A signed-in session.
struct Session {
  std::string id;
  std::string user;
  std::string token_hash;
  std::string peer;  ///< address of the client that signed in
  std::int64_t create_ms = 0;
  std::int64_t use_ms = 0;
};

/// The properties of a request that identify the caller: some headers, and the client's address.
struct Credentials {
  std::string authorization;         ///< "Bearer KEY"; empty: none
  std::string session;               ///< token of the session cookie; empty: none
  std::optional<std::string> owner;  ///< Hydroprint-Owner: name to use if there are no users
  std::string peer;                  ///< address without port; empty: a call within this process
};

/// The user or program that makes a request. Authenticator determines it once per request.
struct Caller {
  std::string name;
  Role role = Role::kViewer;
  std::string via;            ///< "session", "key 0a1b...", "loopback"
  std::string session;        ///< id of the session; empty if there is none
  bool is_user = true;        ///< false: there are no users, and callers on this machine are admins
  Credentials credentials{};  ///< credentials as received
};

}  // namespace hydroprint::auth
