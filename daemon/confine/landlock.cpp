#include "daemon/confine/landlock.h"

#include <fcntl.h>
#include <linux/landlock.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>

#include "daemon/platform/durable_file.h"

namespace hydroprint::confine {
namespace {

using daemon::UniqueFd;

// Of later versions than the headers of Debian 12.
constexpr std::uint64_t kTruncate = 1 << 14;    // LANDLOCK_ACCESS_FS_TRUNCATE, version 3
constexpr std::uint64_t kScopeSignal = 1 << 1;  // LANDLOCK_SCOPE_SIGNAL, version 6

constexpr std::uint64_t kRead = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR;
constexpr std::uint64_t kWrite =
    LANDLOCK_ACCESS_FS_WRITE_FILE | LANDLOCK_ACCESS_FS_REMOVE_DIR | LANDLOCK_ACCESS_FS_REMOVE_FILE |
    LANDLOCK_ACCESS_FS_MAKE_CHAR | LANDLOCK_ACCESS_FS_MAKE_DIR | LANDLOCK_ACCESS_FS_MAKE_REG |
    LANDLOCK_ACCESS_FS_MAKE_SOCK | LANDLOCK_ACCESS_FS_MAKE_FIFO | LANDLOCK_ACCESS_FS_MAKE_BLOCK |
    LANDLOCK_ACCESS_FS_MAKE_SYM | LANDLOCK_ACCESS_FS_REFER | kTruncate;
// Of the worker's own folder. A device would open a way around the rules.
constexpr std::uint64_t kOwn =
    kRead | (kWrite & ~(LANDLOCK_ACCESS_FS_MAKE_CHAR | LANDLOCK_ACCESS_FS_MAKE_BLOCK));
constexpr std::uint64_t kOnFiles =
    LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_WRITE_FILE | kTruncate;

// Not the other devices, such as the drive's serial port and terminals.
constexpr std::array kSystem{"/usr",  "/lib", "/lib64", "/lib32",      "/bin",        "/etc",
                             "/proc", "/sys", "/opt",   "/dev/random", "/dev/urandom"};

struct Rules {
  UniqueFd fd;
  std::uint64_t known = 0;  // rights
};

// Allows access below a path; a missing path needs no rule.
bool allow(const Rules& rules, const std::filesystem::path& path, std::uint64_t access) {
  const UniqueFd place(::open(path.c_str(), O_PATH | O_CLOEXEC));
  if (!place.valid()) return errno == ENOENT || errno == EACCES;
  if (!std::filesystem::is_directory(path)) access &= kOnFiles;
  const landlock_path_beneath_attr rule{access & rules.known, place.get()};
  return ::syscall(SYS_landlock_add_rule, rules.fd.get(), LANDLOCK_RULE_PATH_BENEATH, &rule, 0) ==
         0;
}

// Returns the folder of a program. Resolves links, because the program's files are next to the file
// itself.
std::filesystem::path folder_of(const std::filesystem::path& program) {
  std::error_code ignored;
  return std::filesystem::weakly_canonical(program, ignored).parent_path();
}

}  // namespace

int landlock_version() {
  const long answer =
      ::syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
  return answer > 0 ? static_cast<int>(answer) : 0;
}

LandlockRuleset ruleset_of(int version) {
  LandlockRuleset out{kRead | kWrite};
  if (version < 2) out.files &= ~static_cast<std::uint64_t>(LANDLOCK_ACCESS_FS_REFER);
  if (version < 3) out.files &= ~kTruncate;
  if (version >= 6) out.scoped = kScopeSignal;
  return out;
}

bool restrict_files(const Files& files, int version) {
  const LandlockRuleset all = ruleset_of(version);
  const Rules rules{
      UniqueFd(static_cast<int>(::syscall(SYS_landlock_create_ruleset, &all, sizeof all, 0))),
      all.files};
  bool good = rules.fd.valid();
  for (const char* path : kSystem) good = good && allow(rules, path, kRead);
  return good && allow(rules, "/dev/null", kOnFiles) &&
         allow(rules, folder_of(files.program), kRead) && allow(rules, files.inputs, kRead) &&
         allow(rules, files.work, kOwn) &&
         ::syscall(SYS_landlock_restrict_self, rules.fd.get(), 0) == 0;
}

bool is_within_ruleset(const std::filesystem::path& file, const std::filesystem::path& program) {
  std::error_code ignored;
  const std::filesystem::path real = std::filesystem::weakly_canonical(file, ignored);
  const auto is_below = [&](const std::filesystem::path& folder) {
    return std::mismatch(folder.begin(), folder.end(), real.begin(), real.end()).first ==
           folder.end();
  };
  return std::any_of(kSystem.begin(), kSystem.end(), is_below) || is_below(folder_of(program));
}

}  // namespace hydroprint::confine
