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

/// Commands that start a motion.
[[nodiscard]] bool is_start(const Event& event);
/// What somebody asks for, and may be refused.
[[nodiscard]] bool is_command(const Event& event);

/// One step in words.
[[nodiscard]] std::string text(const Condition& c, const Event& event);

/// Of an event: it brings a look at the drive.
[[nodiscard]] bool has_bits(const Event& event);

/// Every event there can be.
[[nodiscard]] std::vector<Event> all_events();

/// Every value a condition can have, sensible or not.
[[nodiscard]] std::vector<Condition> all_conditions();

/// What must be true of any condition that can come about.
[[nodiscard]] bool makes_sense(const Condition& c);

struct ByFields {
  bool operator()(const Condition& a, const Condition& b) const;
};
using Conditions = std::set<Condition, ByFields>;
using Allowed = std::function<bool(const Event&)>;

/// Called with every step taken from a condition that can be reached.
using Witness = std::function<void(const Condition&, const Event&, const Step&)>;

/// Everything that can be reached from `start` by allowed events, breadth first.
Conditions reach(const Conditions& start, const Allowed& allowed, const Witness& witness = {});

/// Everything that can be reached from the condition at power-on, computed once.
[[nodiscard]] const Conditions& reachable();

/// Those of reachable() that are wanted.
[[nodiscard]] Conditions those(const std::function<bool(const Condition&)>& wanted);

/// Every condition that can be reached, with every event; ends and tells at the first that fails.
void for_each_step(const Witness& claim);

}  // namespace hydroprint::rig
