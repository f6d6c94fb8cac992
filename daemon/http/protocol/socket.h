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

/// One connection's bytes, whatever carries them. All of it is called, and calls back, on the
/// strand of this connection, but post(), which anyone may call. Calls back exactly once each, and
/// never before the call returned. What is read into or written from stays until then.
class Socket {
 public:
  /// What came of reading: bytes; none at the peer's end, after an error or the timeout.
  struct Got {
    std::size_t bytes = 0;
    bool timed_out = false;
  };

  /// How a connection began.
  enum class Opened {
    kYes,
    kNo,         ///< not in time, or not understood
    kPlainHttp,  ///< the client does not speak TLS; it can be told so
  };

  virtual ~Socket() = default;

  /// Agrees with the client on TLS, where that is spoken; before anything else.
  virtual void open(milliseconds timeout, std::function<void(Opened)> done) = 0;
  /// Waits until there is something to read, or the end; true unless it timed out.
  virtual void when_readable(milliseconds timeout, std::function<void(bool)> done) = 0;
  virtual void read_some(char* into, std::size_t size, milliseconds timeout,
                         std::function<void(Got)> done) = 0;
  /// Writes all; false after an error, or if none of it got away within the timeout.
  virtual void write(std::string_view bytes, milliseconds timeout,
                     std::function<void(bool)> done) = 0;

  /// Waits for ring(): true; false if it did not ring in time. A ring before is not lost; one is
  /// kept.
  virtual void wait(milliseconds timeout, std::function<void(bool)> done) = 0;
  virtual void ring() = 0;
  /// Has `gone` called once if the peer ends the connection, or close() is called, before
  /// unwatch(). Does not notice it behind bytes that nobody has read yet. Nothing may be read
  /// meanwhile.
  virtual void watch(std::function<void()> gone) = 0;
  /// Not while something is written.
  virtual void unwatch() = 0;

  /// No more will be written.
  virtual void end_writing() = 0;
  /// Ends whatever is waited for here, as if the peer had gone.
  virtual void close() = 0;
  [[nodiscard]] virtual bool is_closed() const = 0;

  /// Does it on the strand, soon.
  virtual void post(std::function<void()> work) = 0;
  /// "127.0.0.1:40312".
  [[nodiscard]] virtual const std::string& peer() const = 0;
  /// Whether nobody in between can read or change what is said.
  [[nodiscard]] virtual bool is_secure() const = 0;

  // The same to be awaited.
  Awaiting<Opened> opened(milliseconds timeout) {
    return Awaiting<Opened>([this, timeout](auto done) { open(timeout, std::move(done)); });
  }
  Awaiting<bool> readable(milliseconds timeout) {
    return Awaiting<bool>([this, timeout](auto done) { when_readable(timeout, std::move(done)); });
  }
  Awaiting<Got> read(char* into, std::size_t size, milliseconds timeout) {
    return Awaiting<Got>([this, into, size, timeout](auto done) {
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
