#include "daemon/auth/secret.h"

#include <sodium.h>

#include <array>
#include <vector>

#include "sim/base/sha256.h"

namespace hydroprint::auth {

Status start_cryptography() {
  if (sodium_init() >= 0) return {};
  return fail(Code::kInternal, "libsodium cannot be used on this machine",
              ErrorReason::STORE_FAILED);
}

std::string random_hex(std::size_t bytes) {
  std::vector<unsigned char> random(bytes);
  randombytes_buf(random.data(), random.size());
  return to_hex(random);
}

bool equal_in_constant_time(std::string_view a, std::string_view b) {
  return a.size() == b.size() && sodium_memcmp(a.data(), b.data(), a.size()) == 0;
}

std::string csrf_token(std::string_view session_token) {
  constexpr std::string_view kText = "hydroprint csrf 1";
  const auto bytes = [](std::string_view text) {
    return reinterpret_cast<const unsigned char*>(text.data());  // type that the C library expects
  };
  crypto_auth_hmacsha256_state state;
  std::array<unsigned char, crypto_auth_hmacsha256_BYTES> out{};
  crypto_auth_hmacsha256_init(&state, bytes(session_token), session_token.size());
  crypto_auth_hmacsha256_update(&state, bytes(kText), kText.size());
  crypto_auth_hmacsha256_final(&state, out.data());
  return to_hex(out);
}

}  // namespace hydroprint::auth
