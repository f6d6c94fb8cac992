#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace hydroprint::testing {

/// Contents of the PEM files of a certificate and its key.
struct KeyPair {
  std::string certificate, key;
};

/// Requested contents of a certificate.
struct Wanted {
  /// Alternative names, in OpenSSL's notation.
  std::vector<std::string> names{"DNS:localhost", "IP:127.0.0.1"};
  int from_days = -1, to_days = 30;  ///< validity, in days from now
};

/// A certificate authority for tests, which no other program trusts.
class Authority {
 public:
  Authority();
  ~Authority();
  Authority(const Authority&) = delete;
  Authority& operator=(const Authority&) = delete;

  /// The certificate of the authority.
  [[nodiscard]] const std::string& pem() const { return pem_; }
  /// Issues a certificate with a new key.
  [[nodiscard]] KeyPair issue(const Wanted& wanted = {}) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  std::string pem_;
};

/// The paths of a daemon's certificate and key files in a folder.
struct KeyPairFiles {
  explicit KeyPairFiles(const std::filesystem::path& folder)
      : certificate(folder / "certificate.pem"), key(folder / "key.pem") {}

  /// Replaces both files, each atomically.
  void write(const KeyPair& pair) const;

  std::filesystem::path certificate, key;
};

}  // namespace hydroprint::testing
