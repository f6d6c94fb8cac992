#pragma once

#include <functional>
#include <memory>
#include <string>

#include "daemon/http/protocol/socket.h"
#include "daemon/tls/identity.h"
#include "sim/base/result.h"

namespace hydroprint::http {

/// The sockets: a listener and the two threads on which everything of all connections happens, and
/// a third for what may have to wait for others (the store's disk).
class TcpListener {
 public:
  /// Called with each connection, on its strand.
  using Accepted = std::function<void(std::shared_ptr<Socket>)>;

  /// Listens; connections are taken once start() was called.
  /// @param port  0: any
  /// @param identity  what clients are shown; none: TLS is not spoken
  /// @return kUnavailable if the address cannot be had, above all because something else has it
  [[nodiscard]] static Result<std::unique_ptr<TcpListener>> listen(const std::string& host,
                                                                   int port,
                                                                   tls::CurrentIdentity identity);
  /// Stops if stop() was not called. No socket may be used any more.
  ~TcpListener();
  TcpListener(const TcpListener&) = delete;
  TcpListener& operator=(const TcpListener&) = delete;

  [[nodiscard]] int port() const;
  void start(Accepted accepted);
  void stop_accepting();
  /// Ends the threads; what was waited for is not called back any more.
  void stop();
  /// Does it on the thread that may wait, one after the other.
  void aside(std::function<void()> work);

 private:
  TcpListener();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydroprint::http
