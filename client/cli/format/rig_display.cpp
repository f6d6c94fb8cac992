#include "client/cli/format/rig_display.h"

#include <utility>

#include "client/name_of.h"
#include "client/time.h"

namespace hydroprint::cli {
namespace {

using Clock = std::chrono::steady_clock;

// Returns the fault after two spaces; the alarm's own text if the daemon reports no fault.
std::string trouble(const v1::Rig& rig) {
  if (!rig.trouble().empty()) return "  " + printable(rig.trouble());
  std::string text = rig.cause().empty() ? "" : "  " + rig.cause();
  if (rig.alarm_code() != 0)
    text += "  alarm " + std::to_string(rig.alarm_code()) + " " + rig.alarm_text();
  return text;
}

std::string place(const v1::Rig& rig) {
  if (!rig.has_position_mm()) return "";
  std::string text = "  " + format_fixed(rig.position_mm()) + " mm";
  if (rig.has_velocity_mm_per_s()) text += "  " + format_fixed(rig.velocity_mm_per_s()) + " mm/s";
  return text;
}

std::string motion_line(const v1::Motion& motion) {
  std::string text = client::name_of(motion.kind()) + " " + client::name_of(motion.outcome()) +
                     ", from " + format_fixed(motion.begin_mm()) + " to " +
                     format_fixed(motion.end_mm()) + " mm";
  return motion.cause().empty() ? text : text + ": " + motion.cause();
}

std::string axis_line(const v1::Axis& axis) {
  return axis.drive() + (axis.is_virtual() ? " (virtual rig)" : "") + ", from " +
         format_fixed(axis.min_mm()) + " to " + format_fixed(axis.max_mm()) + " mm at up to " +
         format_fixed(axis.max_speed_mm_per_s()) + " mm/s; stopping distance at most " +
         format_fixed(axis.stopping_distance_mm()) + " mm";
}

std::string link_line(const v1::LinkQuality& link) {
  return std::to_string(link.polls()) + " polls, " + std::to_string(link.missed_polls()) +
         " without a response; connected " + std::to_string(link.connects()) + " times";
}

}  // namespace

std::string lease_line(const v1::Lease* lease) {
  if (lease == nullptr) return "nobody holds the lease";
  return printable(lease->holder() + " holds the lease for '" + lease->purpose() + "' until ") +
         format_time(client::time_of(lease->expire_time()));
}

std::string rig_line(const v1::Rig& rig) {
  std::string text = client::name_of(rig.state()) + place(rig);
  if (rig.has_lease()) text += "  lease: " + printable(rig.lease().holder());
  if (!rig.dip().empty()) text += "  dip: " + rig.dip();
  return text + trouble(rig);
}

std::string rig_lines(const v1::Rig& rig) {
  std::string text = client::name_of(rig.state()) + place(rig) + (rig.homed() ? "  homed" : "") +
                     (rig.stop_button() ? "  stop button" : "") + "\n";
  if (const std::string wrong = trouble(rig); !wrong.empty()) text += wrong.substr(2) + "\n";
  text += lease_line(rig.has_lease() ? &rig.lease() : nullptr) + "\n";
  if (!rig.dip().empty()) text += "dip:    " + rig.dip() + "\n";
  if (rig.has_motion()) text += "motion: " + motion_line(rig.motion()) + "\n";
  if (rig.has_axis()) text += "drive:  " + axis_line(rig.axis()) + "\n";
  return text + "link:   " + link_line(rig.link_quality()) + "\n";
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
