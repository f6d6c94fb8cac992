#pragma once

#include <filesystem>

namespace hydroprint::confine {

/// The files of a worker. All else that it can read are system files.
struct Files {
  std::filesystem::path program;  ///< its folder is readable, because its modules are there
  std::filesystem::path inputs;   ///< readable folder
  std::filesystem::path work;     ///< readable and writable folder
};

/// Returns the version of Landlock; 0 if the kernel has none.
[[nodiscard]] int landlock_version();

/// Limits the files that the calling thread can access, permanently, enforced by the kernel
/// (Landlock). An untrusted model that refers to textures in "/home/..." cannot read them, and a
/// compromised worker cannot change other files. Readable: the system (/usr, /lib, /etc, /proc,
/// ...) and `files`. Does nothing if the kernel has no Landlock. The no_new_privs attribute must be
/// set before.
/// @return false if the kernel refuses; errno has the reason
[[nodiscard]] bool restrict_files(const Files& files);

/// Returns whether workers that run `program` can read this file although it is not an input,
/// because it is a system file or in the program's folder.
[[nodiscard]] bool is_within_ruleset(const std::filesystem::path& file,
                                     const std::filesystem::path& program);

}  // namespace hydroprint::confine
