#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "sim/base/result.h"

using SSL_CTX = struct ssl_ctx_st;

namespace hydroprint::tls {

/// A server's certificate with its chain and key. Immutable; a renewed certificate is a new object.
class Identity {
 public:
  /// Reads PEM files: the server's certificate with its chain, and the key. Accepts an expired
  /// certificate.
  /// @return kInvalidArgument, CONFIG_INVALID, as one line with the file and the remedy. Reasons: a
  /// file is unreadable, larger than 1 MiB or not PEM; the key is readable by others, has a
  /// passphrase or belongs to another certificate; the certificate is too weak.
  [[nodiscard]] static Result<std::shared_ptr<const Identity>> read(
      const std::filesystem::path& certificate_file, const std::filesystem::path& key_file);

  [[nodiscard]] const std::string& chain_pem() const { return chain_pem_; }
  [[nodiscard]] const std::string& key_pem() const { return key_pem_; }
  /// Returns the host names and addresses in the certificate, written as in a URL:
  /// "rig.example.org", "*.example.org", "192.168.1.20", "[fd00::20]".
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  /// Returns the expiry as Unix time in s.
  [[nodiscard]] std::int64_t expire_s() const { return expire_s_; }
  /// Returns settings for a server's connections: TLS 1.2 and later, without session resumption.
  [[nodiscard]] SSL_CTX* context() const { return context_.get(); }

 private:
  Identity() = default;

  std::string chain_pem_, key_pem_;
  std::vector<std::string> names_;
  std::int64_t expire_s_ = 0;
  std::shared_ptr<SSL_CTX> context_;
};

/// Returns the current identity; thread-safe.
using CurrentIdentity = std::function<std::shared_ptr<const Identity>()>;

/// Returns whether the identity covers a host, given as in a URL without port. A wildcard covers
/// one label.
[[nodiscard]] bool stands_for(const Identity& identity, std::string_view host);

}  // namespace hydroprint::tls
