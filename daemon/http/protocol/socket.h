#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "daemon/http/protocol/task.h"

namespace hydroprint::http {

using std::chrono::milliseconds;

/// A connection that transfers bytes, with or without TLS. All functions and callbacks run on the
/// connection's strand, except post(), which is thread-safe. Each callback is called exactly once,
/// after the function has returned. Buffers must stay valid until the callback is called.
class Socket {
 public:
  /// Result of a read. `bytes` is 0 if the peer has ended the stream, after an error, or on
  /// timeout.
  struct ReadResult {
    std::size_t bytes = 0;
    bool timed_out = false;
  };

  /// Result of opening a connection.
  enum class OpenResult {
    kYes,
    kNo,         ///< timeout or handshake failure
    kPlainHttp,  ///< the client does not use TLS; the server can reply in plain HTTP
  };

  virtual ~Socket() = default;

  /// Performs the TLS handshake, if TLS is used. Must be called first.
  virtual void open(milliseconds timeout, std::function<void(OpenResult)> done) = 0;
  /// Waits until data or the end of the stream arrives; false on timeout.
  virtual void when_readable(milliseconds timeout, std::function<void(bool)> done) = 0;
  virtual void read_some(char* into, std::size_t size, milliseconds timeout,
                         std::function<void(ReadResult)> done) = 0;
  /// Writes all bytes; false after an error, or if no byte was sent within the timeout.
  virtual void write(std::string_view bytes, milliseconds timeout,
                     std::function<void(bool)> done) = 0;

  /// Waits for ring(); false on timeout. A ring() since the previous wait ends the wait at once.
  virtual void wait(milliseconds timeout, std::function<void(bool)> done) = 0;
  virtual void ring() = 0;
  /// Calls `gone` once if the peer disconnects or close() is called before unwatch(). A disconnect
  /// is not noticed while received bytes are unread. Must not be combined with reads.
  virtual void watch(std::function<void()> gone) = 0;
  /// Must not be called during a write.
  virtual void unwatch() = 0;

  /// Half-closes the connection.
  virtual void end_writing() = 0;
  /// Cancels all pending operations, as if the peer had disconnected.
  virtual void close() = 0;
  [[nodiscard]] virtual bool is_closed() const = 0;

  /// Schedules `work` on the strand.
  virtual void post(std::function<void()> work) = 0;
  /// Returns the address of the peer: "127.0.0.1:40312".
  [[nodiscard]] virtual const std::string& peer() const = 0;
  /// Returns whether the connection is encrypted.
  [[nodiscard]] virtual bool is_secure() const = 0;

  // The functions above as awaitables.
  Awaiting<OpenResult> opened(milliseconds timeout) {
    return Awaiting<OpenResult>([this, timeout](auto done) { open(timeout, std::move(done)); });
  }
  Awaiting<bool> readable(milliseconds timeout) {
    return Awaiting<bool>([this, timeout](auto done) { when_readable(timeout, std::move(done)); });
  }
  Awaiting<ReadResult> read(char* into, std::size_t size, milliseconds timeout) {
    return Awaiting<ReadResult>([this, into, size, timeout](auto done) {
      read_some(into, size, timeout, std::move(done));
    });
  }
  Awaiting<bool> written(std::string_view bytes, milliseconds timeout) {
    return Awaiting<bool>(
        [this, bytes, timeout](auto done) { write(bytes, timeout, std::move(done)); });
  }
  Awaiting<bool> rung(milliseconds timeout) {
    return Awaiting<bool>([this, timeout](auto done) { wait(timeout, std::move(done)); });
  }
};

}  // namespace hydroprint::http
