#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace hydroprint {

/// SHA-256 of bytes added in pieces. Throws std::bad_alloc if the library runs out of memory.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;

  void add(std::string_view bytes);
  /// 64 lower-case hex digits; ends the digest.
  [[nodiscard]] std::string finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// SHA-256 of bytes as 64 lower-case hex digits.
[[nodiscard]] std::string sha256(std::string_view bytes);

/// Two lower-case hex digits per byte.
[[nodiscard]] std::string to_hex(std::span<const unsigned char> bytes);

}  // namespace hydroprint
