#include "daemon/http/protocol/tls_transport.h"

#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/ssl.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <limits>

namespace hydroprint::http {
namespace {

using Outcome = Step::Outcome;

// This and the functions below implement a BIO that calls send() with MSG_NOSIGNAL. OpenSSL's own
// BIO would raise SIGPIPE when a client disconnects, which would end the program.
int socket_of(BIO* bio) {
  return static_cast<int>(reinterpret_cast<std::intptr_t>(BIO_get_data(bio)));
}

int write_to_socket(BIO* bio, const char* bytes, int size) {
  BIO_clear_retry_flags(bio);
  const auto sent =
      ::send(socket_of(bio), bytes, static_cast<std::size_t>(size), MSG_NOSIGNAL | MSG_DONTWAIT);
  if (sent < 0 && (errno == EAGAIN || errno == EINTR)) BIO_set_retry_write(bio);
  return static_cast<int>(sent);
}

int read_from_socket(BIO* bio, char* into, int size) {
  BIO_clear_retry_flags(bio);
  const auto got = ::recv(socket_of(bio), into, static_cast<std::size_t>(size), MSG_DONTWAIT);
  if (got < 0 && (errno == EAGAIN || errno == EINTR)) BIO_set_retry_read(bio);
  return static_cast<int>(got);
}

long control(BIO*, int command, long, void*) { return command == BIO_CTRL_FLUSH ? 1 : 0; }

const BIO_METHOD* socket_method() {
  static BIO_METHOD* const method = [] {
    BIO_METHOD* bio_method = BIO_meth_new(BIO_get_new_index() | BIO_TYPE_SOURCE_SINK, "socket");
    if (bio_method == nullptr) return bio_method;
    BIO_meth_set_write(bio_method, write_to_socket);
    BIO_meth_set_read(bio_method, read_from_socket);
    BIO_meth_set_ctrl(bio_method, control);
    return bio_method;
  }();
  return method;
}

int clamped(std::size_t size) {
  return static_cast<int>(std::min<std::size_t>(size, std::numeric_limits<int>::max()));
}

class TlsTransport final : public Transport {
 public:
  TlsTransport(int socket, std::shared_ptr<const tls::Identity> identity)
      : identity_(std::move(identity)), socket_(socket), ssl_(SSL_new(identity_->context())) {
    BIO* const bio = BIO_new(socket_method());
    if (!ssl_ || bio == nullptr) {
      BIO_free(bio);
      ssl_.reset();
      return;
    }
    BIO_set_data(bio, reinterpret_cast<void*>(static_cast<std::intptr_t>(socket)));
    BIO_set_init(bio, 1);
    SSL_set_bio(ssl_.get(), bio, bio);
    SSL_set_accept_state(ssl_.get());
  }
  [[nodiscard]] bool is_made() const { return ssl_ != nullptr; }

  Step open() override {
    ERR_clear_error();
    const int result = SSL_do_handshake(ssl_.get());
    if (result == 1) is_open_ = true;
    if (result != 1 && ERR_GET_REASON(ERR_peek_error()) == SSL_R_HTTP_REQUEST) {
      return {Outcome::kPlainHttp};
    }
    return outcome(result);
  }
  Step read(char* into, std::size_t size) override {
    ERR_clear_error();
    return outcome(SSL_read(ssl_.get(), into, clamped(size)));
  }
  Step write(std::string_view bytes) override {
    ERR_clear_error();
    return outcome(SSL_write(ssl_.get(), bytes.data(), clamped(bytes.size())));
  }
  Step look() override {
    char byte = 0;
    ERR_clear_error();
    return outcome(SSL_peek(ssl_.get(), &byte, 1));
  }
  [[nodiscard]] bool has_some() const override { return SSL_has_pending(ssl_.get()) == 1; }
  void end() override {
    if (is_open_ && !is_broken_) SSL_shutdown(ssl_.get());
    ERR_clear_error();
    ::shutdown(socket_, SHUT_WR);
  }
  [[nodiscard]] bool is_secure() const override { return true; }

 private:
  Step outcome(int result) {
    if (result > 0) return {Outcome::kDone, static_cast<std::size_t>(result)};
    switch (SSL_get_error(ssl_.get(), result)) {
      case SSL_ERROR_WANT_READ:
        return {Outcome::kNeedsInput};
      case SSL_ERROR_WANT_WRITE:
        return {Outcome::kNeedsOutput};
      case SSL_ERROR_ZERO_RETURN:
        return {Outcome::kOver};
      default:
        is_broken_ = true;  // after this, OpenSSL forbids further calls
        return {Outcome::kOver};
    }
  }

  struct Deleter {
    void operator()(SSL* ssl) const { SSL_free(ssl); }
  };

  std::shared_ptr<const tls::Identity> identity_;
  int socket_;
  std::unique_ptr<SSL, Deleter> ssl_;
  bool is_open_ = false, is_broken_ = false;
};

}  // namespace

std::unique_ptr<Transport> tls_transport(int socket,
                                         std::shared_ptr<const tls::Identity> identity) {
  auto transport = std::make_unique<TlsTransport>(socket, std::move(identity));
  if (!transport->is_made()) return nullptr;
  return transport;
}

}  // namespace hydroprint::http
