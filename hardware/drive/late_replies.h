#pragma once

#include <chrono>
#include <vector>

#include "hardware/drive/pdu.h"

namespace hydroprint::drive {

/// The requests whose replies are missing and may still arrive.
/// A drive replies in the order of the requests, so a valid reply to a later one ends the list.
class LateReplies {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  /// Adds a request whose reply may arrive until a point in time.
  void add(const Request& request, TimePoint until);
  void clear() { requests_.clear(); }
  /// Returns whether any reply may still arrive at this time.
  [[nodiscard]] bool expects_any(TimePoint now) const;

  /// Returns the time from which no late reply can be taken for the reply to this request; the
  /// distant past if that is already so.
  [[nodiscard]] TimePoint clear_for(const Request& request) const;

 private:
  struct Missing {
    Request request;
    TimePoint until;
  };
  std::vector<Missing> requests_;
};

}  // namespace hydroprint::drive
