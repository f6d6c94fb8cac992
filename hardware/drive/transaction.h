#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <vector>

#include "hardware/drive/endpoint.h"
#include "hardware/drive/pdu.h"
#include "sim/base/result.h"

namespace hydroprint::drive {

/// The timeouts of a link.
struct LinkTiming {
  std::chrono::milliseconds connect{500};
  /// Timeout for a reply, in addition to its transmission time on a serial line.
  std::chrono::milliseconds response{150};
  std::chrono::milliseconds worst_delay{500};  ///< after this time a reply can no longer arrive
};

/// The priority of a request when two threads use the line.
enum class Urgency {
  kNormal,
  kStop,  ///< precedes all waiting kNormal requests and does not wait for silence
};

/// A Modbus connection, TCP or RTU, over libmodbus. Thread-safe; requests are sent one at a time.
/// Every call ends within `response` (plus the `response` of another thread on the line). On RTU, a
/// failure adds at most `worst_delay`: the line stays silent for that time, and its input is
/// discarded before the next request, so that a late reply is not mistaken for another one. On TCP
/// a failure closes the connection. Requests are never sent twice, and only connect() connects.
class Link {
 public:
  Link(Endpoint endpoint, const LinkTiming& timing);
  ~Link();
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  /// Reopens the connection; on RTU, locks the line for this process. On failure returns
  /// kUnavailable, reason RIG_OFFLINE, with a list of things to check.
  [[nodiscard]] Status connect();

  /// Closes the connection, if it is open.
  void close();

  [[nodiscard]] bool is_open() const;

  /// Returns the number of connections made so far. If the number has changed, the link has been
  /// reconnected, perhaps to another drive.
  [[nodiscard]] std::uint64_t connections() const;

  /// Sends a request and returns its reply: the words read, empty for a write. Errors: those of
  /// decode_reply, and kUnavailable, reason RIG_OFFLINE: no connection, an unplugged line, or no
  /// reply in time (metadata `timeout` = "1": the command may have taken effect).
  [[nodiscard]] Result<std::vector<std::uint16_t>> transact(const Request& request,
                                                            Urgency urgency = Urgency::kNormal);

  /// Must be called if a well-formed reply has the wrong content. Treats the reply as a failure of
  /// the link.
  void distrust();

  [[nodiscard]] const Endpoint& endpoint() const;
  [[nodiscard]] const LinkTiming& timing() const;

 private:
  class Line;
  std::unique_ptr<Line> line_;
};

/// Returns the link for stopping while `link` is busy or does not respond: another TCP connection;
/// on RTU, which has only one line, the same link (with Urgency::kStop).
[[nodiscard]] std::shared_ptr<Link> stop_link(const std::shared_ptr<Link>& link);

}  // namespace hydroprint::drive
