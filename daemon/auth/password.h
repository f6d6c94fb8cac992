#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "sim/base/result.h"

namespace hydroprint::auth {

/// What checking one password costs: argon2id's memory and passes.
struct PasswordCost {
  std::int64_t memory_kib = 64 << 10;  ///< at least kLeastPasswordMemory_kib
  std::int64_t passes = 3;             ///< at least 1
};
inline constexpr std::int64_t kLeastPasswordMemory_kib = 8;

/// Refuses (SPEC_INVALID) a password of less than 10 or more than 1000 bytes.
[[nodiscard]] Status check_password_length(const std::string& password);

/// Hashes and checks passwords, two at a time at most, since each takes memory. Any thread may
/// call.
class Passwords {
 public:
  explicit Passwords(const PasswordCost& cost);
  ~Passwords();
  Passwords(const Passwords&) = delete;
  Passwords& operator=(const Passwords&) = delete;

  /// argon2id's text of the password: its parameters, salt and hash.
  /// @return kResourceExhausted: TOO_MANY_ATTEMPTS if others keep it busy, OUT_OF_MEMORY
  [[nodiscard]] Result<std::string> hash(const std::string& password);

  /// Whether it is the password. Where there is none (`hashed` is empty) that is false, and takes
  /// as long. Errors as above.
  [[nodiscard]] Result<bool> check(const std::string& password, const std::string& hashed);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydroprint::auth
