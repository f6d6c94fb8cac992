#include "daemon/workers/slurm/folder_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <sstream>

#include "daemon/platform/durable_file.h"

namespace hydroprint::daemon::slurm {
namespace {

constexpr std::int64_t kMostSilence_s = 60;
constexpr int kTries = 5;  // to create the lock, while others come and go

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::string first_word_of(const std::filesystem::path& path) {
  std::istringstream words(text_of(path));
  std::string word;
  words >> word;
  return word;
}

std::string this_host() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "?";
}

// Returns where process ids are unique: this boot of this machine, and this container.
std::string place() {
  std::error_code ignored;
  return first_word_of("/proc/sys/kernel/random/boot_id") + "/" +
         std::filesystem::read_symlink("/proc/self/ns/pid", ignored).string();
}

// Returns when a process was started, which distinguishes it from later ones with its id. Empty if
// it does not exist.
std::string start_of(pid_t pid) {
  std::string stat = text_of(fmt::format("/proc/{}/stat", pid));
  const std::size_t name_end = stat.rfind(')');  // the name may contain spaces
  if (name_end == std::string::npos) return {};
  std::istringstream fields(stat.substr(name_end + 1));
  std::string field;
  constexpr int kStartTime = 20;  // of the fields after the name, see proc(5)
  for (int i = 0; i < kStartTime; ++i) fields >> field;
  return field;
}

struct Holder {
  std::string host;
  pid_t pid = 0;
  std::string place, start;
};

Holder parse(const std::string& words) {
  Holder out;
  std::istringstream(words) >> out.host >> out.pid >> out.place >> out.start;
  return out;
}

// The last word makes each lock unique, also within a process.
std::string own_words() {
  return fmt::format("{} {} {} {} {}\n", this_host(), ::getpid(), place(), start_of(::getpid()),
                     first_word_of("/proc/sys/kernel/random/uuid"));
}

std::int64_t changed_s(const std::filesystem::path& path) {
  struct stat info {};
  return ::stat(path.c_str(), &info) == 0 ? info.st_mtim.tv_sec : 0;
}

// Returns the time since the last heartbeat, by the clock of the file system.
Result<std::int64_t> age_s(const std::filesystem::path& file, const std::string& token) {
  const std::filesystem::path clock = file.string() + ".clock-" + token;
  HP_RETURN_IF_ERROR(write_file(clock, "now\n"));
  const std::int64_t now_s = changed_s(clock);
  discard(clock);
  return now_s - changed_s(file);
}

bool has_ended(const Holder& holder) {
  return holder.place == place() && !holder.start.empty() && start_of(holder.pid) != holder.start;
}

tl::unexpected<Error> refusal(const std::filesystem::path& file, const Holder& holder,
                              std::int64_t age) {
  return fail(Code::kFailedPrecondition,
              fmt::format("{}: another hydroprintd (process {} on {}) hands over jobs here; stop "
                          "it, choose another workers.slurm.installation, or wait {} s if it has "
                          "ended",
                          file.string(), holder.pid, holder.host.empty() ? "?" : holder.host,
                          std::max<std::int64_t>(1, kMostSilence_s - age)));
}

// Creates the lock; false if it exists.
Result<bool> create(const std::filesystem::path& file, const std::string& words) {
  const UniqueFd created(::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
  if (!created.valid()) {
    if (errno == EEXIST) return false;
    return system_failure(file, "cannot be created");
  }
  if (const Status written = write_at(created, file, words, 0); !written) {
    discard(file);
    return tl::unexpected(written.error());
  }
  return true;
}

// Removes a lock whose holder is gone. If another daemon has taken it in this moment, gives it
// back.
Status remove_stale(const std::filesystem::path& file, const std::string& words,
                    const std::string& token) {
  const std::filesystem::path aside = file.string() + ".stale-" + token;
  if (::rename(file.c_str(), aside.c_str()) != 0) {
    return errno == ENOENT ? Status() : system_failure(file, "cannot be taken over");
  }
  if (text_of(aside) != words && ::link(aside.c_str(), file.c_str()) != 0) {
    discard(aside);
    return system_failure(file, "cannot be given back");
  }
  discard(aside);
  return {};
}

}  // namespace

Result<FolderLock> FolderLock::take(const std::filesystem::path& folder) {
  HP_RETURN_IF_ERROR(make_folder(folder));
  const std::filesystem::path file = folder / "lock";
  const std::string own = own_words();
  const std::string token = first_word_of("/proc/sys/kernel/random/uuid");
  Holder holder;
  std::int64_t age = 0;
  for (int i = 0; i < kTries; ++i) {
    HP_ASSIGN_OR_RETURN(const bool is_ours, create(file, own));
    if (is_ours) return FolderLock(file, own);
    const std::string words = text_of(file);
    holder = parse(words);
    HP_ASSIGN_OR_RETURN(age, age_s(file, token));
    if (!has_ended(holder) && age < kMostSilence_s) break;
    HP_RETURN_IF_ERROR(remove_stale(file, words, token));
  }
  return refusal(file, holder, age);
}

FolderLock::FolderLock(FolderLock&& other) noexcept
    : file_(std::exchange(other.file_, {})), words_(std::move(other.words_)) {}

FolderLock::~FolderLock() {
  if (!file_.empty() && text_of(file_) == words_) discard(file_);
}

Status FolderLock::beat() const {
  HP_ASSIGN_OR_RETURN(const bool was_missing, create(file_, words_));
  if (was_missing) return {};
  const UniqueFd file(::open(file_.c_str(), O_RDONLY | O_CLOEXEC));
  std::string words(words_.size() + 1, '\0');
  const ssize_t count = file.valid() ? ::pread(file.get(), words.data(), words.size(), 0) : -1;
  if (count < 0) return system_failure(file_, "cannot be read");
  words.resize(static_cast<std::size_t>(count));
  if (words != words_) return refusal(file_, parse(words), 0);
  if (::utimensat(AT_FDCWD, file_.c_str(), nullptr, 0) == 0) return {};
  return system_failure(file_, "cannot be changed");
}

}  // namespace hydroprint::daemon::slurm
