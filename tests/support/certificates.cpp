#include "tests/support/certificates.h"

#include <openssl/ec.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509v3.h>

#include <fstream>
#include <stdexcept>

namespace hydroprint::testing {
namespace {

struct Deleter {
  void operator()(BIO* bio) const { BIO_free(bio); }
  void operator()(X509* certificate) const { X509_free(certificate); }
  void operator()(EVP_PKEY* key) const { EVP_PKEY_free(key); }
  void operator()(X509_EXTENSION* extension) const { X509_EXTENSION_free(extension); }
};
template <class T>
using Owned = std::unique_ptr<T, Deleter>;

Owned<EVP_PKEY> make_key() { return Owned<EVP_PKEY>(EVP_EC_gen("P-256")); }

template <class Write>
std::string pem_of(const Write& write) {
  const Owned<BIO> bio(BIO_new(BIO_s_mem()));
  if (write(bio.get()) != 1) throw std::runtime_error("cannot write PEM");
  char* bytes = nullptr;
  const long size = BIO_get_mem_data(bio.get(), &bytes);
  return {bytes, static_cast<std::size_t>(size)};
}

std::string pem_of(X509& certificate) {
  return pem_of([&](BIO* bio) { return PEM_write_bio_X509(bio, &certificate); });
}

void extend(X509& certificate, X509& issuer, int what, const std::string& value) {
  X509V3_CTX context;
  X509V3_set_ctx(&context, &issuer, &certificate, nullptr, nullptr, 0);
  const Owned<X509_EXTENSION> extension(
      X509V3_EXT_conf_nid(nullptr, &context, what, value.c_str()));
  if (!extension || X509_add_ext(&certificate, extension.get(), -1) != 1) {
    throw std::runtime_error("cannot add the extension " + value);
  }
}

// Without an issuer, the certificate is self-signed.
Owned<X509> make_certificate(EVP_PKEY& key, const std::string& name, const Wanted& wanted,
                             X509* issuer, EVP_PKEY& issuer_key) {
  Owned<X509> made(X509_new());
  X509& certificate = *made;
  X509_set_version(&certificate, X509_VERSION_3);
  long serial = 0;
  RAND_bytes(reinterpret_cast<unsigned char*>(&serial), 4);
  ASN1_INTEGER_set(X509_get_serialNumber(&certificate), serial);
  constexpr long kDay_s = 24L * 3600;
  X509_gmtime_adj(X509_getm_notBefore(&certificate), wanted.from_days * kDay_s);
  X509_gmtime_adj(X509_getm_notAfter(&certificate), wanted.to_days * kDay_s);
  X509_set_pubkey(&certificate, &key);
  X509_NAME_add_entry_by_txt(X509_get_subject_name(&certificate), "CN", MBSTRING_ASC,
                             reinterpret_cast<const unsigned char*>(name.c_str()), -1, -1, 0);
  const bool is_authority = issuer == nullptr;
  if (is_authority) issuer = made.get();
  X509_set_issuer_name(&certificate, X509_get_subject_name(issuer));
  extend(certificate, *issuer, NID_basic_constraints,
         is_authority ? "critical,CA:TRUE" : "CA:FALSE");
  extend(certificate, *issuer, NID_subject_key_identifier, "hash");
  std::string names;
  for (const std::string& one : wanted.names) names += (names.empty() ? "" : ",") + one;
  if (!is_authority && !names.empty()) {
    extend(certificate, *issuer, NID_subject_alt_name, names);
  }
  if (X509_sign(&certificate, &issuer_key, EVP_sha256()) == 0)
    throw std::runtime_error("cannot sign the certificate");
  return made;
}

void replace(const std::filesystem::path& file, const std::string& content) {
  const std::filesystem::path part = file.string() + ".new";
  std::filesystem::remove(part);
  std::ofstream(part, std::ios::binary) << content;
  std::filesystem::permissions(
      part, std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  std::filesystem::rename(part, file);
}

}  // namespace

struct Authority::Impl {
  Owned<EVP_PKEY> key;
  Owned<X509> certificate;
};

Authority::Authority() : impl_(std::make_unique<Impl>()) {
  impl_->key = make_key();
  impl_->certificate =
      make_certificate(*impl_->key, "an authority of tests", {{}, -400, 400}, nullptr, *impl_->key);
  pem_ = pem_of(*impl_->certificate);
}

Authority::~Authority() = default;

KeyPair Authority::issue(const Wanted& wanted) const {
  const auto key = make_key();
  const auto certificate =
      make_certificate(*key, "hydroprintd", wanted, impl_->certificate.get(), *impl_->key);
  return {pem_of(*certificate), pem_of([&](BIO* bio) {
            return PEM_write_bio_PrivateKey(bio, key.get(), nullptr, nullptr, 0, nullptr, nullptr);
          })};
}

void KeyPairFiles::write(const KeyPair& pair) const {
  replace(certificate, pair.certificate);
  replace(key, pair.key);
}

}  // namespace hydroprint::testing
