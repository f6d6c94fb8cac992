#pragma once

#include <filesystem>

#include "daemon/platform/durable_file.h"

namespace hydroprint::daemon {

/// Which files a worker can get at, enforced by the kernel (Landlock): a model from a stranger that
/// names the textures "/home/..." sees nothing, and a worker that was taken over changes nothing.
/// Readable: the system (/usr, /lib, /etc, /proc, ...), the worker program's folder and `inputs`.
/// Writable: `work`. Nothing else.
/// @return a descriptor for enter_fence(), or an invalid one where the kernel has no Landlock
[[nodiscard]] Result<UniqueFd> make_fence(const std::filesystem::path& program,
                                          const std::filesystem::path& inputs,
                                          const std::filesystem::path& work);

/// Whether the kernel has Landlock.
[[nodiscard]] bool fences_work();

/// Whether the workers of `program` may read this file although the daemon gave them no such input:
/// what is among the system's files or beside the program.
[[nodiscard]] bool is_within_fence(const std::filesystem::path& file,
                                   const std::filesystem::path& program);

/// Confines the calling thread, which must have given up new privileges, for good. Takes no locks.
[[nodiscard]] bool enter_fence(int fence);

}  // namespace hydroprint::daemon
