#pragma once

#include <cstdint>
#include <vector>

#include "hardware/drive/transaction.h"

struct _modbus;

namespace hydroprint::drive {

/// One open connection of libmodbus: closed when this goes. One thread at a time.
class Connection {
 public:
  /// Opens within timing.connect; a serial line is taken for this process alone.
  /// Refuses with kUnavailable, reason RIG_OFFLINE.
  [[nodiscard]] static Result<std::unique_ptr<Connection>> open(const Endpoint& endpoint,
                                                                const LinkTiming& timing);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// How an exchange ended.
  enum class End {
    kReply,    ///< something came that is framed as a reply
    kDamaged,  ///< something came that is not
    kTimeout,
    kLost,  ///< the connection is gone
  };

  /// Empties the line, sends a request as encode_request gives it and waits for the reply, which is
  /// left in `reply` as decode_reply takes it. `cause` is libmodbus's word for what went wrong.
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
  bool owns_ = false;  // the serial line is ours alone
};

}  // namespace hydroprint::drive
