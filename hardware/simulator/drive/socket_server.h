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

/// A socket that listens on loopback or at a path, with a thread for every connection.
class SocketServer {
 public:
  /// Talks over a connection until it ends; the descriptor is closed afterwards. Must return when
  /// reading says that the connection is gone.
  using Serve = std::function<void(int descriptor)>;

  /// Listens at a port of 127.0.0.1 (0: any free one).
  [[nodiscard]] static Result<std::unique_ptr<SocketServer>> tcp(int port, Serve serve);

  /// Listens at a path, for this user alone; what is there is replaced if it is a socket.
  [[nodiscard]] static Result<std::unique_ptr<SocketServer>> local(
      const std::filesystem::path& path, Serve serve);

  /// Ends all connections.
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
  std::list<Client> guests_;  // of the accepting thread
  std::thread thread_;
};

}  // namespace hydroprint::simulated_drive
