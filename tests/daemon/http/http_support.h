#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "daemon/http/server.h"
#include "tests/daemon/api/support.h"
#include "tests/daemon/http/http_client.h"
#include "tests/support/certificates.h"

namespace hydroprint::tests {

/// A daemon that is called over plain HTTP/1.1.
class HttpTest : public ::testing::Test {
 protected:
  HttpAnswer get(const std::string& target, const std::string& fields = "") {
    return ask(daemon.http(), "GET", target, "", fields);
  }
  HttpAnswer post(const std::string& target, const std::string& body) {
    return ask(daemon.http(), "POST", target, body);
  }
  /// Uploads over HTTP; returns "assets/{sha256}".
  std::string upload(const std::string& bytes);
  /// Creates a job over HTTP whose mesh has this content; returns "jobs/{number}".
  std::string simulate(const std::string& mesh);

  TemporaryFolder folder;
  DaemonProcess daemon{folder.path(), DaemonProcess::fake()};
  Client client{daemon.address()};
};

/// The HTTP server in this process, connected to a separate daemon. Needed to test limits, which
/// the daemon does not make configurable. The parameter selects TLS.
class HttpLimits : public HttpTest, public ::testing::WithParamInterface<bool> {
 protected:
  /// Restarts the server, with TLS if the parameter is true.
  void serve(const http::Limits& limits);
  /// Whether a new server stops without waiting for the clients that `open` connects. Waiting takes
  /// at least 2 s every time, so one faster stop is enough, and delays of a busy machine do not
  /// matter.
  [[nodiscard]] bool stops_at_once(const std::function<std::vector<HttpConnection>()>& open);
  [[nodiscard]] const std::string& address() const { return address_; }
  [[nodiscard]] HttpConnection connect(int receive_buffer_bytes = 0) const {
    return HttpConnection(address_, receive_buffer_bytes, GetParam() ? authority.pem() : "");
  }

  hydroprint::testing::Authority authority;
  std::unique_ptr<http::Server> server;

 private:
  std::string address_;
};

/// Resident memory of a process, from /proc.
[[nodiscard]] std::size_t memory_bytes(pid_t pid);

}  // namespace hydroprint::tests
