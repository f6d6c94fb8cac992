#include "client/rig.h"

#include <unistd.h>

#include <chrono>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "client/cli/commands/commands.h"
#include "client/cli/format/durations.h"
#include "client/cli/format/json.h"
#include "client/cli/format/rig_display.h"
#include "client/cli/job_io/field_help.h"
#include "client/cli/program/program.h"
#include "client/cli/rig_session/held_lease.h"
#include "client/cli/rig_session/jog.h"
#include "client/cli/rig_session/motion.h"
#include "client/cli/rig_session/stop_alarm.h"
#include "client/cli/terminal/console.h"

namespace hydroprint::cli {
namespace {

constexpr char kLeaseFooter[] =
    "Needs the lease: 'hydroprint rig lease acquire --purpose ...', or --with-lease.\n\n";

Status show(const Program& program, const Result<v1::Rig>& rig, bool whole = false) {
  if (!rig) return tl::unexpected(rig.error());
  if (program.json())
    print(*rig);
  else
    std::cout << (whole ? rig_lines(*rig) : rig_line(*rig) + "\n") << std::flush;
  return {};
}

Status watch(Program& program, double rate_hz) {
  RigDisplay display(STDOUT_FILENO);
  StopAlarm alarm;
  for (bool seen = false;;) {
    const Status watched = client::watch_rig(program.daemon(), rate_hz, [&](const v1::Rig& rig) {
      seen = true;
      alarm.look(rig);
      program.json() ? print(rig) : display.update(rig);
      return static_cast<bool>(std::cout);
    });
    if (watched) return {};
    if (watched.error().code != Code::kUnavailable || !seen) return watched;
    if (!program.json()) display.say("hydroprint: " + watched.error().message + "; trying again");
    seen = false;
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
  }
}

// Options of commands that need the lease.
struct CommandOptions {
  std::string with_lease;
  double position_mm = 0;
  std::optional<double> speed_mm_per_s;
  bool no_wait = false;
};

using Order = Result<v1::Rig> (*)(client::Connection&, const std::string&);

Status command(Program& program, const CommandOptions& options, Order order) {
  HP_ASSIGN_OR_RETURN(const auto lease, HeldLease::take(program, options.with_lease));
  return show(program, order(program.daemon(), lease->id()));
}

template <class Motion>
Status drive(Program& program, const CommandOptions& options, const Motion& motion) {
  HP_ASSIGN_OR_RETURN(const auto lease, HeldLease::take(program, options.with_lease));
  auto begun = motion(program.daemon(), lease->id());
  if (options.no_wait && begun) return show(program, begun);
  return show(program, wait_for_motion(program, std::move(begun)));
}

void add_rig_status(CLI::App& parent, Program& program) {
  for (CLI::App* shown :
       {&parent, parent.add_subcommand("status", "Show the state of the rig (default)")})
    program.on(*shown,
               [&program] { return show(program, client::get_rig(program.daemon()), true); });
}

void add_rig_watch(CLI::App& parent, Program& program) {
  auto rate_hz = std::make_shared<double>(10);
  CLI::App* command =
      parent.add_subcommand("watch", "Show the rig's state continuously, until Ctrl-C");
  command->add_option("--rate", *rate_hz, "Maximum rate of messages")
      ->type_name("HZ")
      ->check(field_range("WatchRigRequest.max_rate_hz"))
      ->capture_default_str();
  command->footer(
      "Updates one line on a terminal. Elsewhere it prints a line for each change, as JSON with "
      "--json.");
  program.on(*command, [&program, rate_hz] { return watch(program, *rate_hz); });
}

void add_order(CLI::App& parent, Program& program, const char* name, const char* help,
               const char* footer, Order order) {
  auto options = std::make_shared<CommandOptions>();
  CLI::App* command_ = parent.add_subcommand(name, help);
  add_lease_flag(*command_, options->with_lease);
  command_->footer(std::string(kLeaseFooter) + footer);
  program.on(*command_, [&program, options, order] { return command(program, *options, order); });
}

void add_wait_flag(CLI::App& command, CommandOptions& options) {
  command.add_flag("--no-wait", options.no_wait,
                   "Return once the axis moves; Ctrl-C then no longer stops it");
  add_lease_flag(command, options.with_lease);
}

void add_home(CLI::App& parent, Program& program) {
  auto options = std::make_shared<CommandOptions>();
  CLI::App* command = parent.add_subcommand("home", "Home the axis");
  add_wait_flag(*command, *options);
  command->footer(std::string(kLeaseFooter) +
                  "Waits until the motion ends; Ctrl-C stops the axis. Exits with 0 only if the "
                  "axis is homed.\n\n"
                  "Example:\n"
                  "  hydroprint rig home --with-lease 'setting up'");
  program.on(*command, [&program, options] { return drive(program, *options, client::home_rig); });
}

void add_rig_move(CLI::App& parent, Program& program) {
  auto options = std::make_shared<CommandOptions>();
  CLI::App* command = parent.add_subcommand("move", "Move the axis to a position");
  command
      ->add_option("position", options->position_mm, "Target position: 0 is home, positive is down")
      ->type_name("MM")
      ->required();
  command->add_option("--speed", options->speed_mm_per_s, "Speed; default 5")->type_name("MM/S");
  add_wait_flag(*command, *options);
  command->footer(std::string(kLeaseFooter) +
                  "Waits until the motion ends; Ctrl-C stops the axis. Exits with 0 only if "
                  "the axis arrived.\n\n"
                  "Example:\n"
                  "  hydroprint rig move 120 --speed 8");
  program.on(*command, [&program, options] {
    return drive(program, *options, [&](client::Connection& daemon, const std::string& lease_id) {
      return client::move_rig(daemon, lease_id, options->position_mm, options->speed_mm_per_s);
    });
  });
}

void add_jog(CLI::App& parent, Program& program) {
  auto options = std::make_shared<JogOptions>();
  CLI::App* command = parent.add_subcommand("jog", "Move the axis while a key is held");
  command->add_option("--speed", options->speed_mm_per_s, "Speed, positive is down; default 2")
      ->type_name("MM/S");
  add_duration(*command, "--for", options->time_s,
               "Move for this time instead, without keys: 1.5s, 500ms");
  add_lease_flag(*command, options->with_lease);
  command->footer(
      std::string(kLeaseFooter) +
      "Hold Down or j to go down, Up or k to go up; + and - double and halve the speed; q ends.\n"
      "A terminal reports a held key only by repeating it, so each key event moves the axis for\n"
      "0.2 s. A tap is a short step. A held key continues the motion once the keyboard repeats "
      "it,\n"
      "after about half a second. The axis is stopped 0.2 s after the last repeat. If this "
      "program\n"
      "or its connection is lost, the daemon stops the axis within half a second.\n\n"
      "Examples:\n"
      "  hydroprint rig jog --speed 1\n"
      "  hydroprint rig jog --speed -5 --for 2s");
  program.on(*command, [&program, options] { return jog(program, *options); });
}

// Waits, because only then it is known whether the drive obeys.
Status stop(const Program& program) {
  StopAlarm alarm;
  const auto rig = stop_and_wait(program, alarm);
  if (rig) HP_RETURN_IF_ERROR(stop_obeyed(*rig));
  return show(program, rig);
}

void add_stop(CLI::App& parent, Program& program) {
  CLI::App* command = parent.add_subcommand("stop", "Stop any motion; needs no lease");
  command->footer(
      "This is not an emergency stop. The emergency stop is the button that cuts the power.\n"
      "Waits up to 2 s until the axis is at rest. Fails if the drive does not obey.");
  program.on(*command, [&program] { return stop(program); });
}

}  // namespace

void add_rig(CLI::App& app, Program& program) {
  CLI::App* command = app.add_subcommand("rig", "Watch, move and stop the rig; manage its lease");
  command->require_subcommand(0, 1);
  add_rig_status(*command, program);
  add_rig_watch(*command, program);
  add_order(*command, program, "arm", "Enable the drive's torque", "Example:\n  hydroprint rig arm",
            client::arm_rig);
  add_order(*command, program, "disarm", "Disable the drive's torque",
            "The position is unknown afterwards. A vertical axis without a brake sinks.",
            client::disarm_rig);
  add_home(*command, program);
  add_rig_move(*command, program);
  add_jog(*command, program);
  add_stop(*command, program);
  add_order(*command, program, "reset",
            "Clear the alarm after a fault, or after the stop button was pressed",
            "Starts no motion. Arm and home the axis afterwards.", client::reset_rig);
  add_lease(*command, program);
  command->footer(
      "Examples:\n  hydroprint rig lease acquire --purpose 'new bath'\n  hydroprint rig arm\n"
      "  hydroprint rig home\n  hydroprint rig move 120\n  hydroprint rig stop\n"
      "  hydroprint rig lease release");
}

}  // namespace hydroprint::cli
