#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <thread>

#include "sim/base/result.h"

namespace hydroprint::simulated_drive {

/// A server socket on loopback or at a path, with a thread for every connection.
class SocketServer {
 public:
  /// Serves a connection until it ends; the descriptor is closed afterwards. The function must
  /// return when a read reports a closed connection.
  using Serve = std::function<void(int descriptor)>;

  /// Listens on a port of 127.0.0.1 (0: any free port).
  [[nodiscard]] static Result<std::unique_ptr<SocketServer>> tcp(int port, Serve serve);

  /// Listens at a path, for this user only; an existing socket is replaced.
  [[nodiscard]] static Result<std::unique_ptr<SocketServer>> local(
      const std::filesystem::path& path, Serve serve);

  /// Closes all connections.
  ~SocketServer();
  SocketServer(const SocketServer&) = delete;
  SocketServer& operator=(const SocketServer&) = delete;

  [[nodiscard]] int port() const { return port_; }

 private:
  struct Client {
    int descriptor = -1;
    std::atomic<bool> gone = false;
    std::thread thread;
  };

  SocketServer(int socket, Serve serve);
  void accept_all();
  void admit(int descriptor);
  void part(bool all);

  int socket_;
  int port_ = 0;
  Serve serve_;
  std::atomic<bool> ends_ = false;
  std::list<Client> clients_;  // connected clients; used by the accepting thread
  std::thread thread_;
};

}  // namespace hydroprint::simulated_drive
