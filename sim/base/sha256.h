#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace hydroprint {

/// Computes a SHA-256 hash incrementally. Throws std::bad_alloc if the library runs out of memory.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;

  void add(std::string_view bytes);
  /// Returns the hash as 64 lower-case hex digits. No bytes may be added afterwards.
  [[nodiscard]] std::string finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Returns the SHA-256 hash of bytes as 64 lower-case hex digits.
[[nodiscard]] std::string sha256(std::string_view bytes);

/// Returns two lower-case hex digits per byte.
[[nodiscard]] std::string to_hex(std::span<const unsigned char> bytes);

}  // namespace hydroprint
