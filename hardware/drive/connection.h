#pragma once

#include <cstdint>
#include <vector>

#include "hardware/drive/transaction.h"

struct _modbus;

namespace hydroprint::drive {

/// An open libmodbus connection, closed by the destructor. Not thread-safe.
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
    kReply,    ///< a correctly framed reply arrived
    kDamaged,  ///< the bytes received are not a valid reply frame
    kTimeout,
    kLost,  ///< the connection is lost
  };

  /// Discards pending input, sends a request from encode_request and waits for the reply, which is
  /// stored in `reply` for decode_reply. `cause` receives a description of the error.
  End exchange(int unit, const std::vector<std::uint8_t>& request, std::size_t reply_bytes,
               std::vector<std::uint8_t>& reply, std::string& cause);

 private:
  Connection(const Endpoint& endpoint, const LinkTiming& timing, _modbus* modbus);
  [[nodiscard]] Status open_tcp();
  [[nodiscard]] Status open_serial();
  End receive(std::vector<std::uint8_t>& reply, std::string& cause);

  Endpoint endpoint_;
  LinkTiming timing_;
  _modbus* modbus_;
  int lock_ = -1;      // second descriptor of a serial line, which holds the lock
  bool owns_ = false;  // this process has locked the serial line
};

}  // namespace hydroprint::drive
