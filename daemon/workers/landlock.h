#pragma once

#include <filesystem>

#include "daemon/platform/durable_file.h"

namespace hydroprint::daemon {

/// Limits the files that a worker can access, enforced by the kernel (Landlock). An untrusted model
/// that refers to textures in "/home/..." cannot read them, and a compromised worker cannot change
/// other files. Readable: the system (/usr, /lib, /etc, /proc, ...), the worker program's folder
/// and `inputs`. Writable: `work`.
/// @return a descriptor for apply_ruleset(), or an invalid one if the kernel has no Landlock
[[nodiscard]] Result<UniqueFd> make_ruleset(const std::filesystem::path& program,
                                            const std::filesystem::path& inputs,
                                            const std::filesystem::path& work);

/// Returns whether the kernel has Landlock.
[[nodiscard]] bool fences_work();

/// Returns whether workers that run `program` can read this file although it is not an input,
/// because it is a system file or in the program's folder.
[[nodiscard]] bool is_within_ruleset(const std::filesystem::path& file,
                                     const std::filesystem::path& program);

/// Confines the calling thread permanently. The no_new_privs attribute must be set before. Acquires
/// no locks.
[[nodiscard]] bool apply_ruleset(int ruleset);

}  // namespace hydroprint::daemon
