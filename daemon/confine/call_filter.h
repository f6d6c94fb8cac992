#pragma once

namespace hydroprint::confine {

/// Refuses the system calls with which a compromised worker could harm others (README.md), for the
/// calling process and every program that it becomes, permanently. The process must have one
/// thread, and the no_new_privs attribute must be set before. Programs for i386 and x32 are killed.
/// @return false if the kernel refuses; errno has the reason
[[nodiscard]] bool filter_system_calls();

}  // namespace hydroprint::confine
