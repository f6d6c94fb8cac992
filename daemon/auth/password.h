#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "sim/base/result.h"

namespace hydroprint::auth {

/// The cost of one password check: the memory and passes of argon2id.
struct PasswordCost {
  std::int64_t memory_kib = 64 << 10;  ///< at least kLeastPasswordMemory_kib
  std::int64_t passes = 3;             ///< at least 1
};
inline constexpr std::int64_t kLeastPasswordMemory_kib = 8;

/// Returns SPEC_INVALID for a password of less than 10 or more than 1000 bytes.
[[nodiscard]] Status check_password_length(const std::string& password);

/// Hashes and checks passwords, at most two at a time, because each check needs much memory.
/// Thread-safe.
class Passwords {
 public:
  explicit Passwords(const PasswordCost& cost);
  ~Passwords();
  Passwords(const Passwords&) = delete;
  Passwords& operator=(const Passwords&) = delete;

  /// Hashes a password with argon2id; the result contains parameters, salt and hash.
  /// @return kResourceExhausted: TOO_MANY_ATTEMPTS if too many checks are waiting, MEMORY_LIMIT
  [[nodiscard]] Result<std::string> hash(const std::string& password);

  /// Returns whether the password matches. If the user has no password (`hashed` is empty), the
  /// result is false after the same time. Errors as in hash().
  [[nodiscard]] Result<bool> check(const std::string& password, const std::string& hashed);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydroprint::auth
