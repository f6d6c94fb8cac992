#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace hydroprint::testing {

/// PEM files' contents.
struct KeyPair {
  std::string certificate, key;
};

/// What a certificate is to say.
struct Wanted {
  std::vector<std::string> names{"DNS:localhost", "IP:127.0.0.1"};  ///< as OpenSSL writes them
  int from_days = -1, to_days = 30;                                 ///< from now
};

/// An authority of the test's own, whose certificates nobody else trusts.
class Authority {
 public:
  Authority();
  ~Authority();
  Authority(const Authority&) = delete;
  Authority& operator=(const Authority&) = delete;

  /// Its own certificate.
  [[nodiscard]] const std::string& pem() const { return pem_; }
  /// A certificate with a new key.
  [[nodiscard]] KeyPair issue(const Wanted& wanted = {}) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  std::string pem_;
};

/// The files of a daemon's certificate, in a folder.
struct KeyPairFiles {
  explicit KeyPairFiles(const std::filesystem::path& folder)
      : certificate(folder / "certificate.pem"), key(folder / "key.pem") {}

  /// Replaces both, each at once, as one should.
  void write(const KeyPair& pair) const;

  std::filesystem::path certificate, key;
};

}  // namespace hydroprint::testing
