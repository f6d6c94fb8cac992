#pragma once

#include <cstdint>
#include <filesystem>

namespace hydroprint::confine {

/// The files of a worker. All else that it can read are system files.
struct Files {
  std::filesystem::path program;  ///< its folder is readable, because its modules are there
  std::filesystem::path inputs;   ///< readable folder
  std::filesystem::path work;     ///< readable and writable folder
};

/// Returns the version of Landlock; 0, with the reason in errno, if the kernel has none.
[[nodiscard]] int landlock_version();

/// The kernel's struct landlock_ruleset_attr. Headers of Debian 12 have only its first member;
/// kernels that do not know the others accept them as 0.
struct LandlockRuleset {
  std::uint64_t files = 0;    ///< rights that are denied where no rule allows them
  std::uint64_t network = 0;  ///< always 0, because no sockets can be opened
  std::uint64_t scoped = 0;   ///< what must not reach processes outside
};

/// Returns what restrict_files() demands from a kernel with this version of Landlock: the rights
/// and scopes that the version knows. A kernel refuses others.
[[nodiscard]] LandlockRuleset ruleset_of(int version);

/// Limits the files that the calling thread can access, permanently, enforced by the kernel
/// (Landlock). An untrusted model that refers to textures in "/home/..." cannot read them, and a
/// compromised worker cannot change other files. Readable: the system (/usr, /lib, /etc, /proc,
/// ..., of /dev only null and random numbers) and `files`. From version 6, other processes get no
/// signals. The no_new_privs attribute must be set before.
/// @param version  of Landlock, at least 1; the kernel's or less
/// @return false if the kernel refuses; errno has the reason
[[nodiscard]] bool restrict_files(const Files& files, int version);

/// Returns whether workers that run `program` can read this file although it is not an input,
/// because it is a system file or in the program's folder.
[[nodiscard]] bool is_within_ruleset(const std::filesystem::path& file,
                                     const std::filesystem::path& program);

}  // namespace hydroprint::confine
