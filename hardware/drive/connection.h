#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "hardware/drive/reply_reader.h"
#include "hardware/drive/transaction.h"

struct _modbus;

namespace hydroprint::drive {

/// An open connection, closed by the destructor. libmodbus opens serial lines; the frames are this
/// folder's own (frame.h), because libmodbus sends every request with transaction id 0 and can
/// neither drop an echo nor accept another unit. Not thread-safe.
class Connection {
 public:
  /// Opens a connection within timing.connect; locks a serial line for this process. Returns
  /// kUnavailable, reason RIG_OFFLINE, on failure.
  [[nodiscard]] static Result<std::unique_ptr<Connection>> open(const Endpoint& endpoint,
                                                                const LinkTiming& timing);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// The result of an exchange.
  enum class End {
    kReply,    ///< reader.reply() has a value
    kDamaged,  ///< the reply is damaged
    kEcho,     ///< the request itself came back
    kTimeout,
    kLost,  ///< the connection is lost
  };

  /// Discards pending input and returns whether there was any.
  bool discard_input();

  /// Sends the reader's request and passes what arrives to the reader, for at most `patience`.
  /// `cause` receives the reason of kLost.
  End exchange(ReplyReader& reader, std::chrono::nanoseconds patience, std::string& cause);

 private:
  using TimePoint = std::chrono::steady_clock::time_point;

  explicit Connection(const Endpoint& endpoint) : endpoint_(endpoint) {}
  [[nodiscard]] Status open_tcp(const LinkTiming& timing);
  [[nodiscard]] Status open_serial();
  [[nodiscard]] bool wait(short events, TimePoint until) const;
  [[nodiscard]] bool send(const std::vector<std::uint8_t>& bytes, TimePoint until) const;

  Endpoint endpoint_;
  _modbus* modbus_ = nullptr;  // serial lines only
  int line_ = -1;              // of modbus_ on a serial line
  int lock_ = -1;              // second descriptor of a serial line, which holds the lock
  bool owns_ = false;          // this process has locked the serial line
};

}  // namespace hydroprint::drive
