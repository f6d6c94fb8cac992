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

/// A certificate with its chain and the key to it: what a server shows to its clients. Does not
/// change; a renewed one is another.
class Identity {
 public:
  /// Reads PEM files: the server's certificate and those that lead to its authority's, and the
  /// key. A certificate that has expired is read like any other.
  /// @return kInvalidArgument, CONFIG_INVALID, as one line with the file and the remedy: a file
  ///   that cannot be read, is larger than 1 MiB or no PEM; a key that others may read, that has a
  ///   passphrase or belongs to another certificate; a certificate too weak to be used
  [[nodiscard]] static Result<std::shared_ptr<const Identity>> read(
      const std::filesystem::path& certificate_file, const std::filesystem::path& key_file);

  [[nodiscard]] const std::string& chain_pem() const { return chain_pem_; }
  [[nodiscard]] const std::string& key_pem() const { return key_pem_; }
  /// Names and addresses it stands for, as they are written in a URL: "rig.example.org",
  /// "*.example.org", "192.168.1.20", "[fd00::20]".
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  /// Unix time, s, from which on clients refuse it.
  [[nodiscard]] std::int64_t expire_s() const { return expire_s_; }
  /// Settings for a server's connections: TLS 1.2 and later, nothing kept of past ones.
  [[nodiscard]] SSL_CTX* context() const { return context_.get(); }

 private:
  Identity() = default;

  std::string chain_pem_, key_pem_;
  std::vector<std::string> names_;
  std::int64_t expire_s_ = 0;
  std::shared_ptr<SSL_CTX> context_;
};

/// The identity that counts now; any thread may ask.
using CurrentIdentity = std::function<std::shared_ptr<const Identity>()>;

/// Whether that host, as a URL has it but without port, is one of the identity's names; a name
/// with a star stands for one label.
[[nodiscard]] bool stands_for(const Identity& identity, std::string_view host);

}  // namespace hydroprint::tls
