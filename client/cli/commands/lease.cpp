#include "client/lease.h"

#include <chrono>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "client/cli/commands/commands.h"
#include "client/cli/format/durations.h"
#include "client/cli/format/json.h"
#include "client/cli/format/rig_display.h"
#include "client/cli/program/program.h"
#include "client/cli/rig_session/held_lease.h"
#include "client/cli/rig_session/lease_file.h"
#include "client/cli/terminal/console.h"

namespace hydroprint::cli {
namespace {

struct LeaseOptions {
  std::string purpose, reason;
  std::optional<double> time_s;

  [[nodiscard]] std::chrono::seconds time() const {
    if (!time_s) return kLeaseTime;
    return std::chrono::seconds(std::llround(std::ceil(*time_s)));
  }
};

void print_result(const Program& program, const v1::Lease& lease) {
  if (program.json())
    print(lease);
  else
    std::cout << lease_line(&lease) << std::endl;
}

// Returns the lease id stored for this daemon.
Result<std::string> our_lease(const Program& program) {
  if (auto kept = kept_lease(program.server())) return *kept;
  return fail(Code::kFailedPrecondition,
              lease_file(program.server()).string() +
                  ": no lease is stored in this file; acquire a lease with 'hydroprint rig lease "
                  "acquire --purpose ...'",
              ErrorReason::LEASE_REQUIRED);
}

Status show_lease(Program& program) {
  const auto lease = client::get_lease(program.daemon());
  if (!lease && lease.error().reason != ErrorReason::LEASE_NOT_FOUND)
    return tl::unexpected(lease.error());
  if (lease)
    print_result(program, *lease);
  else if (program.json())
    print(Json::object());
  else
    std::cout << lease_line(nullptr) << std::endl;
  return {};
}

Status acquire(Program& program, const LeaseOptions& options) {
  HP_ASSIGN_OR_RETURN(const v1::Lease lease,
                      client::acquire_lease(program.daemon(), options.purpose, options.time()));
  if (Status kept = keep_lease(program.server(), lease.lease_id()); !kept) {
    static_cast<void>(client::release_lease(program.daemon(), lease.lease_id()));
    return kept;
  }
  print_result(program, lease);
  return {};
}

Status renew(Program& program, const LeaseOptions& options) {
  HP_ASSIGN_OR_RETURN(const std::string lease_id, our_lease(program));
  HP_ASSIGN_OR_RETURN(const v1::Lease lease,
                      client::renew_lease(program.daemon(), lease_id, options.time()));
  print_result(program, lease);
  return {};
}

Status release(Program& program) {
  if (const auto lease_id = kept_lease(program.server())) {
    HP_RETURN_IF_ERROR(client::release_lease(program.daemon(), *lease_id));
    forget_lease(program.server(), *lease_id);
  }
  return show_lease(program);
}

Status break_it(Program& program, const LeaseOptions& options) {
  HP_RETURN_IF_ERROR(client::break_lease(program.daemon(), options.reason));
  return show_lease(program);
}

void add_time_flag(CLI::App& command, LeaseOptions& options) {
  add_duration(command, "--for", options.time_s, "Duration: 1s to 8h; default 10min");
}

void add_acquire(CLI::App& parent, Program& program) {
  auto options = std::make_shared<LeaseOptions>();
  CLI::App* command = parent.add_subcommand("acquire", "Acquire the lease if nobody holds it");
  command
      ->add_option("--purpose", options->purpose, "Reason; shown to others who request the lease")
      ->type_name("TEXT")
      ->required();
  add_time_flag(*command, *options);
  command->footer(
      "The lease is stored for later commands, one for each --server, in a file that only you\n"
      "can read: in $XDG_RUNTIME_DIR/hydroprint, or else in ~/.local/state/hydroprint.\n\n"
      "Example:\n"
      "  hydroprint rig lease acquire --purpose 'dip of the mug' --for 30min");
  program.on(*command, [&program, options] { return acquire(program, *options); });
}

void add_renew(CLI::App& parent, Program& program) {
  auto options = std::make_shared<LeaseOptions>();
  CLI::App* command =
      parent.add_subcommand("renew", "Renew your lease; the new duration starts now");
  add_time_flag(*command, *options);
  program.on(*command, [&program, options] { return renew(program, *options); });
}

void add_break(CLI::App& parent, Program& program) {
  auto options = std::make_shared<LeaseOptions>();
  CLI::App* command = parent.add_subcommand("break", "Take the lease away from its holder");
  command
      ->add_option("--reason", options->reason,
                   "Reason; the daemon logs it with your name and the holder's")
      ->type_name("TEXT")
      ->required();
  command->footer("A jog ends; a dip continues. Ask first: somebody may be working at the rig.");
  program.on(*command, [&program, options] { return break_it(program, *options); });
}

}  // namespace

void add_lease(CLI::App& parent, Program& program) {
  CLI::App* command =
      parent.add_subcommand("lease", "Manage the exclusive right to command the rig");
  command->require_subcommand(1);
  program.on(*command->add_subcommand("show", "Show who holds the lease"),
             [&program] { return show_lease(program); });
  add_acquire(*command, program);
  add_renew(*command, program);
  program.on(*command->add_subcommand("release", "Release your lease"),
             [&program] { return release(program); });
  add_break(*command, program);
}

}  // namespace hydroprint::cli
