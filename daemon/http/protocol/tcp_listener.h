#pragma once

#include <functional>
#include <memory>
#include <string>

#include "daemon/http/protocol/socket.h"
#include "daemon/tls/identity.h"
#include "sim/base/result.h"

namespace hydroprint::http {

/// Owns the listening socket, two threads that run all connections, and a third thread for work
/// that may block (disk access of the store).
class TcpListener {
 public:
  /// Called for each connection, on its strand.
  using Accepted = std::function<void(std::shared_ptr<Socket>)>;

  /// Binds the address; connections are accepted after start().
  /// @param port      0: any free port
  /// @param identity  TLS certificate and key; empty: without TLS
  /// @return kUnavailable if the address cannot be bound, usually because another program uses it
  [[nodiscard]] static Result<std::unique_ptr<TcpListener>> listen(const std::string& host,
                                                                   int port,
                                                                   tls::CurrentIdentity identity);
  /// Calls stop() if needed. No socket may be used afterwards.
  ~TcpListener();
  TcpListener(const TcpListener&) = delete;
  TcpListener& operator=(const TcpListener&) = delete;

  [[nodiscard]] int port() const;
  void start(Accepted accepted);
  void stop_accepting();
  /// Ends the threads; pending callbacks are not called any more.
  void stop();
  /// Runs `work` on the blocking thread, one task at a time.
  void run_blocking(std::function<void()> work);

 private:
  TcpListener();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydroprint::http
