#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <vector>

#include "hardware/drive/endpoint.h"
#include "hardware/drive/pdu.h"
#include "sim/base/result.h"

namespace hydroprint::drive {

/// How long a link waits.
struct LinkTiming {
  std::chrono::milliseconds connect{500};
  std::chrono::milliseconds response{150};     ///< for a reply, besides its time on a serial line
  std::chrono::milliseconds worst_delay{500};  ///< after which the drive surely answers no more
};

/// Who goes first when two threads want the line.
enum class Urgency {
  kNormal,
  kStop,  ///< goes before any kNormal that waits, and does not wait for silence
};

/// A Modbus connection, TCP or RTU, over libmodbus. Any thread may call; requests go one at a time.
///
/// Every call ends: within `response` (plus, if another thread is on the line, its `response`), and
/// on RTU after a failure at most `worst_delay` later: then the line stays silent for so long and
/// is emptied before the next request, so that no late reply is taken for another's. On TCP a
/// failure closes the connection. Nothing is ever sent twice, and nothing but connect() connects.
class Link {
 public:
  Link(Endpoint endpoint, const LinkTiming& timing);
  ~Link();
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  /// Opens the connection anew; on RTU takes the line for this process alone.
  /// Refuses with kUnavailable, reason RIG_OFFLINE, saying what to check.
  [[nodiscard]] Status connect();

  /// Closes the connection; does nothing if it is closed.
  void close();

  [[nodiscard]] bool is_open() const;

  /// How often it was connected. A number other than before: another connection, and who knows to
  /// what.
  [[nodiscard]] std::uint64_t connections() const;

  /// One request and its reply: the words read, none for a write. Refuses what decode_reply
  /// refuses; with kUnavailable, reason RIG_OFFLINE: no connection, no reply in time (metadata
  /// `timeout` = "1": whether the drive obeyed is unknown), line unplugged.
  [[nodiscard]] Result<std::vector<std::uint16_t>> transact(const Request& request,
                                                            Urgency urgency = Urgency::kNormal);

  /// To be called when a reply, though well formed, was not what was asked for: as after a failure.
  void distrust();

  [[nodiscard]] const Endpoint& endpoint() const;
  [[nodiscard]] const LinkTiming& timing() const;

 private:
  class Line;
  std::unique_ptr<Line> line_;
};

/// The link by which to stop while `link` is busy or stuck: another TCP connection; the same link
/// on RTU, where there is one line (and Urgency::kStop).
[[nodiscard]] std::shared_ptr<Link> stop_link(const std::shared_ptr<Link>& link);

}  // namespace hydroprint::drive
