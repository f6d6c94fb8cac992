#include "daemon/tls/grpc_credentials.h"

#include <grpc/grpc.h>
#include <grpc/grpc_security.h>

#include <mutex>
#include <utility>

namespace hydroprint::daemon {
namespace {

/// Credentials from gRPC's C interface, which requests the certificate at every handshake. The
/// classes of gRPC's C++ interface do not suffice: they keep a certificate forever, or watch the
/// files and have no certificate while the pair does not match.
class TlsCredentials final : public grpc::ServerCredentials {
 public:
  explicit TlsCredentials(tls::CurrentIdentity identity)
      : identity_(std::move(identity)),
        credentials_(grpc_ssl_server_credentials_create_with_options(
            grpc_ssl_server_credentials_create_options_using_config_fetcher(
                GRPC_SSL_DONT_REQUEST_CLIENT_CERTIFICATE, fetch, this))) {}
  ~TlsCredentials() override { grpc_server_credentials_release(credentials_); }
  TlsCredentials(const TlsCredentials&) = delete;
  TlsCredentials& operator=(const TlsCredentials&) = delete;

  void SetAuthMetadataProcessor(const std::shared_ptr<grpc::AuthMetadataProcessor>&) override {}

 private:
  int AddPortToServer(const std::string& address, grpc_server* server) override {
    return grpc_server_add_http2_port(server, address.c_str(), credentials_);
  }

  static grpc_ssl_certificate_config_reload_status fetch(
      void* self, grpc_ssl_server_certificate_config** config) {
    return static_cast<TlsCredentials*>(self)->fetch(config);
  }
  grpc_ssl_certificate_config_reload_status fetch(grpc_ssl_server_certificate_config** config) {
    const std::lock_guard lock(mutex_);
    auto current = identity_();
    if (current == shown_) return GRPC_SSL_CERTIFICATE_CONFIG_RELOAD_UNCHANGED;
    const grpc_ssl_pem_key_cert_pair pair{current->key_pem().c_str(), current->chain_pem().c_str()};
    // The roots verify client certificates, which are not requested. However, gRPC 1.51 aborts the
    // program if no roots are passed.
    *config = grpc_ssl_server_certificate_config_create(pair.cert_chain, &pair, 1);
    shown_ = std::move(current);
    return GRPC_SSL_CERTIFICATE_CONFIG_RELOAD_NEW;
  }

  tls::CurrentIdentity identity_;
  std::mutex mutex_;
  std::shared_ptr<const tls::Identity> shown_;
  grpc_server_credentials* credentials_;
};

}  // namespace

std::shared_ptr<grpc::ServerCredentials> tls_credentials(tls::CurrentIdentity identity) {
  return std::make_shared<TlsCredentials>(std::move(identity));
}

}  // namespace hydroprint::daemon
