#include "daemon/tls/identity.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/ssl.h>
#include <openssl/x509v3.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <fstream>

namespace hydroprint::tls {
namespace {

constexpr std::size_t kMostBytes = 1 << 20;
// Ciphers for TLS 1.2; all ciphers of TLS 1.3 are acceptable. All these ciphers provide forward
// secrecy: a stolen key does not reveal earlier connections.
constexpr const char* kCiphers = "ECDHE+AESGCM:ECDHE+CHACHA20";

struct Deleter {
  void operator()(BIO* bio) const { BIO_free(bio); }
  void operator()(X509* certificate) const { X509_free(certificate); }
  void operator()(EVP_PKEY* key) const { EVP_PKEY_free(key); }
  void operator()(GENERAL_NAMES* names) const { GENERAL_NAMES_free(names); }
};
template <class T>
using Owned = std::unique_ptr<T, Deleter>;

tl::unexpected<Error> refused(const std::filesystem::path& file, const std::string& why) {
  return fail(Code::kInvalidArgument, file.string() + ": " + why, ErrorReason::CONFIG_INVALID);
}

std::string openssl_words() {
  const unsigned long error = ERR_peek_last_error();
  const char* const reason = error == 0 ? nullptr : ERR_reason_error_string(error);
  return reason == nullptr ? "" : fmt::format(" ({})", reason);
}

Result<std::string> read_file(const std::filesystem::path& file, const std::string& what,
                              bool is_secret) {
  struct stat info {};
  const bool is_there = ::stat(file.c_str(), &info) == 0;
  if (is_there && !S_ISREG(info.st_mode)) {
    return refused(file, "not a regular file; name the PEM file of the TLS " + what);
  }
  std::ifstream in(file, std::ios::binary);
  if (!is_there || !in) {
    return refused(
        file, fmt::format("the TLS {} cannot be read: {}; name a PEM file that this user can read",
                          what, std::strerror(errno)));
  }
  if (is_secret && (info.st_mode & 07) != 0) {
    return refused(
        file,
        "the TLS key is readable by every user of this machine; run chmod 640, and create "
        "a new key if others may have read it");
  }
  std::string text(kMostBytes + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.size() > kMostBytes) {
    return refused(file, "is larger than 1 MiB; name the PEM file of the TLS " + what);
  }
  return text;
}

Owned<BIO> reader_of(const std::string& text) {
  return Owned<BIO>(BIO_new_mem_buf(text.data(), static_cast<int>(text.size())));
}

std::vector<Owned<X509>> certificates_in(const std::string& text) {
  std::vector<Owned<X509>> all;
  const auto reader = reader_of(text);
  while (X509* one = PEM_read_bio_X509(reader.get(), nullptr, nullptr, nullptr)) {
    all.emplace_back(one);
  }
  return all;
}

// Rejects keys with a passphrase. OpenSSL would read the passphrase from a terminal, which a
// service does not have.
int no_passphrase(char*, int, int, void*) { return -1; }

std::string address_text(const ASN1_OCTET_STRING& bytes) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  const int size = ASN1_STRING_length(&bytes);
  const int family = size == 4 ? AF_INET : AF_INET6;
  if (size != 4 && size != 16) return {};
  if (inet_ntop(family, ASN1_STRING_get0_data(&bytes), text.data(), text.size()) == nullptr) {
    return {};
  }
  return family == AF_INET ? text.data() : fmt::format("[{}]", text.data());
}

std::string text_of(const GENERAL_NAME& name) {
  if (name.type == GEN_IPADD) return address_text(*name.d.iPAddress);
  if (name.type != GEN_DNS) return {};
  std::string text(reinterpret_cast<const char*>(ASN1_STRING_get0_data(name.d.dNSName)),
                   static_cast<std::size_t>(ASN1_STRING_length(name.d.dNSName)));
  const bool is_plain =
      std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c < 0x7f; });
  return is_plain ? text : std::string();
}

std::vector<std::string> names_of(const X509& certificate) {
  std::vector<std::string> names;
  const Owned<GENERAL_NAMES> all(static_cast<GENERAL_NAMES*>(
      X509_get_ext_d2i(&certificate, NID_subject_alt_name, nullptr, nullptr)));
  for (int i = 0; all && i < sk_GENERAL_NAME_num(all.get()); ++i) {
    std::string text = text_of(*sk_GENERAL_NAME_value(all.get(), i));
    if (!text.empty()) names.push_back(std::move(text));
  }
  return names;
}

std::int64_t unix_time(const ASN1_TIME* time) {
  std::tm parts{};
  return ASN1_TIME_to_tm(time, &parts) == 1 ? ::timegm(&parts) : 0;
}

std::shared_ptr<SSL_CTX> server_context() {
  std::shared_ptr<SSL_CTX> context(SSL_CTX_new(TLS_server_method()), SSL_CTX_free);
  if (!context) return context;
  SSL_CTX_set_min_proto_version(context.get(), TLS1_2_VERSION);
  SSL_CTX_set_cipher_list(context.get(), kCiphers);
  SSL_CTX_set_options(context.get(), SSL_OP_NO_RENEGOTIATION | SSL_OP_NO_COMPRESSION |
                                         SSL_OP_CIPHER_SERVER_PREFERENCE);
  SSL_CTX_set_session_cache_mode(context.get(), SSL_SESS_CACHE_OFF);
  // Idle connections release their buffers; partial writes are continued later.
  SSL_CTX_set_mode(context.get(), SSL_MODE_RELEASE_BUFFERS | SSL_MODE_ENABLE_PARTIAL_WRITE |
                                      SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER);
  return context;
}

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c; }

bool is_same(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return lower(x) == lower(y); });
}

}  // namespace

Result<std::shared_ptr<const Identity>> Identity::read(
    const std::filesystem::path& certificate_file, const std::filesystem::path& key_file) {
  std::shared_ptr<Identity> result(new Identity);
  HP_ASSIGN_OR_RETURN(result->chain_pem_, read_file(certificate_file, "certificate", false));
  HP_ASSIGN_OR_RETURN(result->key_pem_, read_file(key_file, "key", true));
  ERR_clear_error();
  const auto chain = certificates_in(result->chain_pem_);
  if (chain.empty()) {
    return refused(certificate_file,
                   "has no certificate in PEM format; such a certificate begins with \"-----BEGIN "
                   "CERTIFICATE-----\"");
  }
  ERR_clear_error();
  const Owned<EVP_PKEY> key(
      PEM_read_bio_PrivateKey(reader_of(result->key_pem_).get(), nullptr, no_passphrase, nullptr));
  if (!key) {
    return refused(key_file, fmt::format("has no key in PEM format without a passphrase{}; convert "
                                         "the key with: openssl pkey -in OLD -out NEW",
                                         openssl_words()));
  }
  if (X509_check_private_key(chain.front().get(), key.get()) != 1) {
    return refused(key_file,
                   fmt::format("is not the key of the first certificate in {}; name a matching "
                               "pair, with the server's certificate first in the file",
                               certificate_file.string()));
  }
  ERR_clear_error();
  result->context_ = server_context();
  SSL_CTX* const context = result->context_.get();
  bool is_good = context != nullptr && SSL_CTX_use_certificate(context, chain[0].get()) == 1 &&
                 SSL_CTX_use_PrivateKey(context, key.get()) == 1;
  for (std::size_t i = 1; is_good && i < chain.size(); ++i) {
    is_good = SSL_CTX_add1_chain_cert(context, chain[i].get()) == 1;
  }
  if (!is_good) {
    return refused(
        certificate_file,
        fmt::format("cannot be used for TLS{}; create a new one, with a key of 2048 bits or more",
                    openssl_words()));
  }
  result->names_ = names_of(*chain.front());
  result->expire_s_ = unix_time(X509_get0_notAfter(chain.front().get()));
  return std::shared_ptr<const Identity>(std::move(result));
}

bool stands_for(const Identity& identity, std::string_view host) {
  const auto& names = identity.names();
  return std::any_of(names.begin(), names.end(), [&](std::string_view name) {
    if (!name.starts_with("*.")) return is_same(name, host);
    const std::size_t dot = host.find('.');
    return dot != std::string_view::npos && dot > 0 && is_same(name.substr(1), host.substr(dot));
  });
}

}  // namespace hydroprint::tls
