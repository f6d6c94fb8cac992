#pragma once

namespace hydroprint::admin {

/// Implements `hydroprintd admin ...`, which `hydroprint admin` runs on the daemon's machine.
/// @param argv  arguments, starting with "admin"
/// @return the exit status
[[nodiscard]] int run_command(int argc, char** argv);

}  // namespace hydroprint::admin
