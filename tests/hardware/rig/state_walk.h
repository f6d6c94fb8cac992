#pragma once

#include <functional>
#include <iosfwd>
#include <set>
#include <string>
#include <vector>

#include "hardware/rig/state.h"

namespace hydroprint::rig {

void PrintTo(const Condition& c, std::ostream* out);
void PrintTo(const Event& event, std::ostream* out);

/// Whether the event is a command that starts a motion.
[[nodiscard]] bool is_start(const Event& event);
/// Whether the event is a command. Commands may be refused.
[[nodiscard]] bool is_command(const Event& event);

/// Describes an event in a condition, for failure messages.
[[nodiscard]] std::string text(const Condition& c, const Event& event);

/// Whether the event is a poll of the drive and so contains the drive's bits.
[[nodiscard]] bool has_bits(const Event& event);

/// The causes of Event::Kind::kFault.
[[nodiscard]] std::vector<Cause> observed_causes();

/// All possible events, with all values of their bits.
[[nodiscard]] std::vector<Event> all_events();

/// All combinations of values of a condition, sensible or not.
[[nodiscard]] std::vector<Condition> all_conditions();

/// Whether the invariants of every reachable condition hold.
[[nodiscard]] bool makes_sense(const Condition& c);

struct ByFields {
  bool operator()(const Condition& a, const Condition& b) const;
};
using Conditions = std::set<Condition, ByFields>;
using Allowed = std::function<bool(const Event&)>;

/// Called with every step from a reachable condition.
using Witness = std::function<void(const Condition&, const Event&, const Step&)>;

/// All conditions reachable from `start` by allowed events, breadth first.
Conditions reach(const Conditions& start, const Allowed& allowed, const Witness& witness = {});

/// All conditions reachable from power-on, computed once.
[[nodiscard]] const Conditions& reachable();

/// The conditions of reachable() that `wanted` accepts.
[[nodiscard]] Conditions those(const std::function<bool(const Condition&)>& wanted);

/// Checks every reachable condition with every event; stops and reports at the first failure.
void for_each_step(const Witness& claim);

}  // namespace hydroprint::rig
