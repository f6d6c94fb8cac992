#pragma once

#include <chrono>
#include <vector>

#include "hardware/drive/pdu.h"

namespace hydroprint::drive {

/// The requests whose replies are missing and may still arrive.
/// A drive replies in the order of the requests, so after a valid reply to a later one no request
/// waits for them. A gateway may still deliver them out of order, so they are remembered.
class LateReplies {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  /// Adds a request whose reply may arrive until a point in time.
  void add(const Request& request, TimePoint until);
  /// Must be called when the drive has replied to a later request.
  void pass_over();
  void clear() { requests_.clear(); }
  /// Returns whether any reply that was not passed over may still arrive at this time.
  [[nodiscard]] bool expects_any(TimePoint now) const;

  /// Returns the time from which no late reply can be taken for the reply to this request if
  /// replies keep their order; the distant past if that is already so.
  [[nodiscard]] TimePoint clear_for(const Request& request) const;

  /// Returns whether at this time a late reply, in order or not, could be taken for the reply to
  /// this request.
  [[nodiscard]] bool may_be_confused(const Request& request, TimePoint now) const;

 private:
  struct Missing {
    Request request;
    TimePoint until;
    bool is_passed_over = false;
  };
  std::vector<Missing> requests_;
};

}  // namespace hydroprint::drive
