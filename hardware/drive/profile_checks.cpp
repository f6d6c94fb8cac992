#include "hardware/drive/profile_checks.h"

#include <fmt/format.h>

#include "hardware/drive/block_parts.h"
#include "hardware/drive/link_budget.h"
#include "sim/base/toml_reader.h"

namespace hydroprint::drive {

void check_parts(TomlReader& top, const DriveProfile& profile) {
  for (const Block& block : profile.blocks) {
    if (!parts_of(profile, block).empty()) continue;
    top.refuse("block",
               fmt::format("at {:#06x} cannot be read again after a bad reply: each way to divide "
                           "it repeats the length of a block. Read one more register in a block",
                           block.address));
  }
}

void check_budget(TomlReader& timing, const DriveProfile& profile) {
  const double needed_s = recovery_time_s(profile);
  const auto check = [&](double limit_s, std::string_view limit) {
    if (needed_s < limit_s) return;
    timing.refuse(
        "response_timeout_s",
        fmt::format("is too long: after a lost reply, the next one may take {:g} s "
                    "(response_timeout_s + {}{:g} s), which must be less than {:g} s, {}. "
                    "Lower response_timeout_s{}",
                    needed_s, profile.bus.silence_after_bad_reply ? "worst_delay_s + " : "",
                    kLongestPollPeriod_s + kRepeatAllowance_s, limit_s, limit,
                    profile.bus.silence_after_bad_reply ? " or worst_delay_s" : ""));
  };
  check(kStale_s, "after which the link counts as lost");
  if (profile.watchdog) check(profile.watchdog->largest_time_s, "watchdog.largest_time_s");
  if (profile.jog_dead_man_s > 0) {
    check(profile.jog_dead_man_s, "motion.jog_dead_man_s (0: do not rely on it)");
  }
}

}  // namespace hydroprint::drive
