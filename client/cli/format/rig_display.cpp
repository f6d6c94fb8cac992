#include "client/cli/format/rig_display.h"

#include <fmt/format.h>

#include <utility>

#include "client/name_of.h"
#include "client/time.h"

namespace hydroprint::cli {
namespace {

using Clock = std::chrono::steady_clock;

// Returns the fault, or at least its cause, and the drive's alarm, each after two spaces.
std::string trouble(const v1::Rig& rig) {
  const std::string fault = rig.trouble().empty() ? rig.cause() : printable(rig.trouble());
  std::string text = fault.empty() ? "" : "  " + fault;
  if (rig.alarm_code() != 0)
    text += fmt::format("  alarm {} {}", rig.alarm_code(), printable(rig.alarm_text()));
  return text;
}

std::string place(const v1::Rig& rig) {
  if (!rig.has_position_mm()) return "";
  std::string text = fmt::format("  {:.2f} mm", rig.position_mm());
  if (rig.has_velocity_mm_per_s()) text += fmt::format("  {:.2f} mm/s", rig.velocity_mm_per_s());
  return text;
}

std::string motion_line(const v1::Motion& motion) {
  return fmt::format("{} {}, from {:.2f} to {:.2f} mm{}{}", client::name_of(motion.kind()),
                     client::name_of(motion.outcome()), motion.begin_mm(), motion.end_mm(),
                     motion.cause().empty() ? "" : ": ", motion.cause());
}

std::string axis_line(const v1::Axis& axis) {
  return fmt::format(
      "{}{}, from {:.2f} to {:.2f} mm at up to {:.2f} mm/s; stopping distance at most {:.2f} mm",
      axis.drive(), axis.is_virtual() ? " (virtual rig)" : "", axis.min_mm(), axis.max_mm(),
      axis.max_speed_mm_per_s(), axis.stopping_distance_mm());
}

std::string link_line(const v1::LinkQuality& link) {
  std::string text = fmt::format("{} polls, {} without a response; connected {} times",
                                 link.polls(), link.missed_polls(), link.connects());
  if (link.damaged_replies() + link.unanswered_requests() + link.retried_reads() > 0) {
    text += fmt::format("; {} damaged and {} missing replies, {} reads repeated",
                        link.damaged_replies(), link.unanswered_requests(), link.retried_reads());
  }
  std::uint64_t replies = 0;
  for (const auto& bucket : link.reply_times()) replies += bucket.replies();
  if (replies == 0) return text;
  return text + fmt::format("; replies take {:.1f} ms on average",
                            1000 * link.reply_time_sum_s() / static_cast<double>(replies));
}

}  // namespace

std::string lease_line(const v1::Lease* lease) {
  if (lease == nullptr) return "nobody holds the lease";
  return printable(fmt::format("{} holds the lease for '{}' until {}", lease->holder(),
                               lease->purpose(),
                               format_time(client::time_of(lease->expire_time()))));
}

std::string rig_line(const v1::Rig& rig) {
  std::string text = client::name_of(rig.state()) + place(rig);
  if (rig.has_lease()) text += "  lease: " + printable(rig.lease().holder());
  if (!rig.dip().empty()) text += "  dip: " + rig.dip();
  return text + trouble(rig);
}

std::string rig_lines(const v1::Rig& rig) {
  std::string text =
      fmt::format("{}{}{}{}\n", client::name_of(rig.state()), place(rig),
                  rig.homed() ? "  homed" : "", rig.stop_button() ? "  stop button" : "");
  if (const std::string wrong = trouble(rig); !wrong.empty()) text += wrong.substr(2) + "\n";
  text += lease_line(rig.has_lease() ? &rig.lease() : nullptr) + "\n";
  if (!rig.dip().empty()) text += fmt::format("dip:    {}\n", rig.dip());
  if (rig.has_motion()) text += fmt::format("motion: {}\n", motion_line(rig.motion()));
  if (rig.has_axis()) text += fmt::format("drive:  {}\n", axis_line(rig.axis()));
  return text + fmt::format("link:   {}\n", link_line(rig.link_quality()));
}

void RigDisplay::update(const v1::Rig& rig) {
  const std::string line = rig_line(rig);
  if (line_.is_terminal()) return line_.show(line);
  v1::Rig anywhere = rig;
  anywhere.clear_position_mm();
  anywhere.clear_velocity_mm_per_s();
  const std::string key = rig_line(anywhere);
  const bool is_news = std::exchange(last_key_, key) != key;
  if (!is_news && (line == last_line_ || Clock::now() - last_time_ < std::chrono::seconds(1)))
    return;
  last_line_ = line;
  last_time_ = Clock::now();
  say(line);
}

}  // namespace hydroprint::cli
