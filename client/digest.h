#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace hydroprint::client {

/// SHA-256 of bytes given piece by piece.
class Digest {
 public:
  Digest();
  ~Digest();
  Digest(const Digest&) = delete;
  Digest& operator=(const Digest&) = delete;

  void add(std::string_view bytes);
  /// 64 lower-case hex digits; ends the digest.
  [[nodiscard]] std::string finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Two lower-case hex digits a byte.
[[nodiscard]] std::string to_hex(std::span<const unsigned char> bytes);

}  // namespace hydroprint::client
