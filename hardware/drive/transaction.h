#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <vector>

#include "hardware/drive/endpoint.h"
#include "hardware/drive/link_statistics.h"
#include "hardware/drive/pdu.h"
#include "sim/base/result.h"

namespace hydroprint::drive {

/// The timeouts of a link, and how its bus differs from plain Modbus.
struct LinkTiming {
  std::chrono::milliseconds connect{500};
  /// Timeout for a reply, in addition to its transmission time on a serial line.
  std::chrono::milliseconds response{150};
  std::chrono::milliseconds worst_delay{500};  ///< after this time a reply can no longer arrive
  BusVariant bus = {};
};

/// The priority of a request when two threads use the line.
enum class Urgency {
  kNormal,
  kStop,  ///< precedes all waiting kNormal requests and does not wait for silence
};

/// A Modbus connection, TCP or RTU. Thread-safe; requests are sent one at a time. Requests are
/// never sent twice, and only connect() connects.
///
/// Pending input is discarded before every request. While a request waits, other bytes and the
/// replies to other requests are passed over and counted. A reply is never taken for that of
/// another request: TCP has transaction ids. RTU has none, so after a missing or damaged reply a
/// request whose reply would look alike (replies_look_alike: a read of equally many words, or the
/// same write) waits until no late reply can arrive (`worst_delay`, or until the drive has replied
/// to another request, because drives reply in order; see may_be_confused()). Other requests are
/// sent at once, unless the drive forbids it (BusVariant::silence_after_bad_reply).
///
/// Every call ends within `worst_delay` + `response` and the transmission time, plus `response` of
/// another thread on the line. A request whose reply would not look like a missing one does not
/// wait for `worst_delay`.
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
  /// decode_reply, and kUnavailable, reason RIG_OFFLINE: no connection, an unplugged line, an
  /// adapter that echoes (seen in reads), or no reply in time. Metadata `timeout` = "1": there was
  /// no reply, or a write's reply was damaged, so the command may have taken effect.
  [[nodiscard]] Result<std::vector<std::uint16_t>> transact(const Request& request,
                                                            Urgency urgency = Urgency::kNormal);

  /// Must be called if a well-formed reply to `request` has the wrong content: it belongs to
  /// another request, so the right one may still arrive.
  void distrust(const Request& request);

  /// Returns whether a reply that is late and out of order, as a gateway may deliver it, could
  /// still be taken for the reply to this request. Always false over TCP.
  [[nodiscard]] bool may_be_confused(const Request& request) const;

  /// Returns how replies have arrived since the start. Does not wait for the line.
  [[nodiscard]] LinkStatistics statistics() const;
  /// Counts a read that its caller repeats.
  void count_retry();

  [[nodiscard]] const Endpoint& endpoint() const;
  [[nodiscard]] const LinkTiming& timing() const;

 private:
  class Line;
  std::unique_ptr<Line> line_;
};

/// Returns the link for stopping while `link` is busy or does not respond: another TCP connection;
/// on RTU (also over TCP), which has only one line, the same link (with Urgency::kStop).
[[nodiscard]] std::shared_ptr<Link> stop_link(const std::shared_ptr<Link>& link);

}  // namespace hydroprint::drive
