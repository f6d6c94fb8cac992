#include "client/connection/tls_probe.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netdb.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/ssl.h>
#include <openssl/x509v3.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <memory>

#include "client/connection/server_address.h"

namespace hydroprint::client {
namespace {

constexpr int kPatience_s = 2;

struct Deleter {
  void operator()(SSL_CTX* context) const { SSL_CTX_free(context); }
  void operator()(SSL* ssl) const { SSL_free(ssl); }
  void operator()(BIO* bio) const { BIO_free(bio); }
  void operator()(X509* certificate) const { X509_free(certificate); }
  void operator()(addrinfo* addresses) const { ::freeaddrinfo(addresses); }
};
template <class T>
using Owned = std::unique_ptr<T, Deleter>;

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int get() const { return number_; }

 private:
  int number_;
};

// Returns a connected socket; -1 if nothing listens.
int connect_to(const ServerAddress& address) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const std::string port = std::to_string(address.port);
  if (::getaddrinfo(address.host.c_str(), port.c_str(), &hints, &found) != 0) return -1;
  const Owned<addrinfo> all(found);
  for (const addrinfo* one = found; one != nullptr; one = one->ai_next) {
    const int descriptor =
        ::socket(one->ai_family, one->ai_socktype | SOCK_CLOEXEC, one->ai_protocol);
    if (descriptor < 0) continue;
    const timeval patience{kPatience_s, 0};  // applies to connecting as well
    ::setsockopt(descriptor, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
    ::setsockopt(descriptor, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    if (::connect(descriptor, one->ai_addr, one->ai_addrlen) == 0) return descriptor;
    ::close(descriptor);
  }
  return -1;
}

void trust(SSL_CTX& context, const std::string& ca_pem) {
  if (ca_pem.empty()) {
    SSL_CTX_set_default_verify_paths(&context);
    return;
  }
  const Owned<BIO> reader(BIO_new_mem_buf(ca_pem.data(), static_cast<int>(ca_pem.size())));
  while (X509* one = PEM_read_bio_X509(reader.get(), nullptr, nullptr, nullptr)) {
    const Owned<X509> certificate(one);
    X509_STORE_add_cert(SSL_CTX_get_cert_store(&context), one);
  }
}

std::string expiry_of(const X509& certificate) {
  const Owned<BIO> text(BIO_new(BIO_s_mem()));
  ASN1_TIME_print(text.get(), X509_get0_notAfter(&certificate));
  char* bytes = nullptr;
  const long size = BIO_get_mem_data(text.get(), &bytes);
  return {bytes, static_cast<std::size_t>(size)};
}

std::string words_for(long verdict, const X509& certificate, const ServerAddress& address) {
  switch (verdict) {
    case X509_V_OK:
      return {};
    case X509_V_ERR_CERT_HAS_EXPIRED:
      return fmt::format(
          "the server's TLS certificate expired on {}; ask the server's operator to renew it",
          expiry_of(certificate));
    case X509_V_ERR_CERT_NOT_YET_VALID:
      return "the server's TLS certificate is not valid yet; check the clocks of both machines";
    case X509_V_ERR_HOSTNAME_MISMATCH:
    case X509_V_ERR_IP_ADDRESS_MISMATCH:
      return fmt::format(
          "the server's TLS certificate is not for the name {}; use a name from the certificate "
          "with --server, or get a certificate for this name",
          address.host);
    default:
      return fmt::format(
          "the server's TLS certificate is not signed by a trusted authority ({}); specify the "
          "authority's certificate with --ca FILE (HYDROPRINT_CA)",
          X509_verify_cert_error_string(verdict));
  }
}

// Blocks SIGPIPE: OpenSSL writes to sockets without MSG_NOSIGNAL, so the signal would end the
// program when the peer is gone.
class WithoutSigpipe {
 public:
  WithoutSigpipe() {
    sigemptyset(&pipe_);
    sigaddset(&pipe_, SIGPIPE);
    ::pthread_sigmask(SIG_BLOCK, &pipe_, &before_);
  }
  ~WithoutSigpipe() {
    const timespec at_once{};
    while (sigismember(&before_, SIGPIPE) == 0 && ::sigtimedwait(&pipe_, nullptr, &at_once) > 0) {
    }
    ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  WithoutSigpipe(const WithoutSigpipe&) = delete;
  WithoutSigpipe& operator=(const WithoutSigpipe&) = delete;

 private:
  sigset_t pipe_{}, before_{};
};

enum class Handshake { kTls, kOther, kUnknown };

// Performs the TLS handshake, and completes it even if the certificate fails verification;
// SSL_get_verify_result() then returns the reason.
Handshake try_handshake(SSL& ssl, const ServerAddress& address, int socket) {
  X509_VERIFY_PARAM* const parameters = SSL_get0_param(&ssl);
  X509_VERIFY_PARAM_set_flags(parameters, X509_V_FLAG_PARTIAL_CHAIN);
  in6_addr ignored{};
  const bool is_address = inet_pton(AF_INET, address.host.c_str(), &ignored) == 1 ||
                          inet_pton(AF_INET6, address.host.c_str(), &ignored) == 1;
  if (is_address) {
    X509_VERIFY_PARAM_set1_ip_asc(parameters, address.host.c_str());
  } else {
    X509_VERIFY_PARAM_set1_host(parameters, address.host.c_str(), 0);
    SSL_set_tlsext_host_name(&ssl, address.host.c_str());
  }
  SSL_set_fd(&ssl, socket);
  ERR_clear_error();
  if (SSL_connect(&ssl) == 1) return Handshake::kTls;
  const bool is_other = ERR_GET_REASON(ERR_peek_error()) == SSL_R_WRONG_VERSION_NUMBER;
  return is_other ? Handshake::kOther : Handshake::kUnknown;
}

}  // namespace

std::string tls_trouble(const ConnectionOptions& options) {
  const auto address = parse_server(options.server);
  if (!address) return {};
  const WithoutSigpipe without_sigpipe;
  const Descriptor socket(connect_to(*address));
  if (socket.get() < 0) return {};
  const Owned<SSL_CTX> context(SSL_CTX_new(TLS_client_method()));
  if (!context) return {};
  trust(*context, options.ca_pem);
  const Owned<SSL> ssl(SSL_new(context.get()));
  if (!ssl) return {};
  const Handshake handshake = try_handshake(*ssl, *address, socket.get());
  ERR_clear_error();
  if (!options.is_tls) {
    if (handshake != Handshake::kTls) return {};
    return fmt::format(
        "the server requires TLS; use --server https://{}, with --ca FILE for a private authority",
        options.server);
  }
  if (handshake == Handshake::kOther) {
    return fmt::format(
        "the server does not speak TLS; check the address, or use --server {} without https:// and "
        "without --ca",
        options.server);
  }
  const Owned<X509> certificate(SSL_get1_peer_certificate(ssl.get()));
  return certificate ? words_for(SSL_get_verify_result(ssl.get()), *certificate, *address) : "";
}

}  // namespace hydroprint::client
