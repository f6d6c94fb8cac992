#include "client/digest.h"

#include <openssl/evp.h>

#include <array>

namespace hydroprint::client {

struct Digest::Impl {
  EVP_MD_CTX* context = EVP_MD_CTX_new();
};

Digest::Digest() : impl_(std::make_unique<Impl>()) {
  EVP_DigestInit_ex(impl_->context, EVP_sha256(), nullptr);
}

Digest::~Digest() { EVP_MD_CTX_free(impl_->context); }

void Digest::add(std::string_view bytes) {
  EVP_DigestUpdate(impl_->context, bytes.data(), bytes.size());
}

std::string Digest::finish() {
  std::array<unsigned char, 32> bytes{};
  EVP_DigestFinal_ex(impl_->context, bytes.data(), nullptr);
  return to_hex(bytes);
}

std::string to_hex(std::span<const unsigned char> bytes) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  text.reserve(2 * bytes.size());
  for (const unsigned char byte : bytes) {
    text += kDigits[byte >> 4U];
    text += kDigits[byte & 0x0fU];
  }
  return text;
}

}  // namespace hydroprint::client
