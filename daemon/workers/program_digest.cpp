#include "daemon/workers/program_digest.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <vector>

#include "daemon/platform/durable_file.h"
#include "daemon/workers/command_run.h"
#include "sim/base/checked_json.h"

namespace hydroprint::daemon {
namespace {

constexpr std::chrono::milliseconds kPatience{30'000};

// Returns what changes whenever a file is replaced; empty if it does not exist.
std::string stamp_of(const std::filesystem::path& path) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0) return {};
  return fmt::format("{} {} {} {}.{}\n", path.filename().string(), info.st_ino, info.st_size,
                     info.st_mtim.tv_sec, info.st_mtim.tv_nsec);
}

bool is_module(const std::filesystem::path& path) {
  return path.extension() == ".so" && path.filename().string().starts_with("hydroprint-");
}

std::string stamp_of_modules(const std::filesystem::path& folder) {
  std::vector<std::string> stamps;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (is_module(entry.path())) stamps.push_back(stamp_of(entry.path()));
  }
  std::sort(stamps.begin(), stamps.end());
  return fmt::format("{}", fmt::join(stamps, ""));
}

Result<std::string> read_build_id(const std::filesystem::path& program) {
  HP_ASSIGN_OR_RETURN(const CommandEnd end,
                      run_command({program.string(), "--version", "--json"}, "/", kPatience));
  if (end.is_late) {
    return fail(Code::kInternal,
                program.string() + " --version does not answer; check workers.program, and retry",
                ErrorReason::WORKER_UNUSABLE);
  }
  const auto answer = parse_json(end.output).value_or(nullptr);
  if (auto build_id = json_string(answer, "build_id")) return *std::move(build_id);
  return sha256_of_file(program);
}

}  // namespace

Result<std::string> ProgramDigest::get() {
  const std::lock_guard lock(mutex_);
  const std::string program = stamp_of(path_);
  if (program.empty()) {
    return fail(Code::kInternal,
                path_.string() + ": the worker program does not exist; check workers.program",
                ErrorReason::WORKER_UNUSABLE);
  }
  const std::string stamp = program + stamp_of_modules(path_.parent_path());
  if (stamp != stamp_) {
    HP_ASSIGN_OR_RETURN(digest_, read_build_id(path_));
    stamp_ = stamp;
  }
  return digest_;
}

}  // namespace hydroprint::daemon
