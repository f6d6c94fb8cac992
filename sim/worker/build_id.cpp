#include "sim/worker/build_id.h"

#include <filesystem>
#include <map>
#include <system_error>
#include <utility>

#include "sim/base/file_digest.h"
#include "sim/base/sha256.h"

namespace hydroprint::worker {
namespace {

namespace fs = std::filesystem;

// The link to the file of this process, even if an update has replaced the file since.
constexpr const char* kThisProgram = "/proc/self/exe";

using PathsByName = std::map<std::string, fs::path>;

bool is_module(const std::string& name) {
  return name.starts_with("hydroprint-") && name.ends_with(".so");
}

/// Returns the program and the modules beside it.
Result<PathsByName> own_files() {
  std::error_code error;
  const fs::path folder = fs::read_symlink(kThisProgram, error).parent_path();
  PathsByName paths = {{"hydroprint-worker", kThisProgram}};
  for (fs::directory_iterator entry(folder, error); !error && entry != fs::directory_iterator();
       entry.increment(error)) {
    const std::string name = entry->path().filename();
    if (is_module(name)) paths.emplace(name, entry->path());
  }
  if (!error) return paths;
  return fail(Code::kInternal, folder.string() + ": the program's folder cannot be read (" +
                                   error.message() + "). Check its permissions");
}

}  // namespace

Result<std::string> build_id() {
  HP_ASSIGN_OR_RETURN(const PathsByName paths, own_files());
  Sha256 hash;
  for (const auto& [name, path] : paths) {
    auto digest = digest_file(path);
    if (!digest) return fail(Code::kInternal, std::move(digest).error().message);
    hash.add(digest->sha256 + "  " + name + "\n");
  }
  return hash.finish();
}

}  // namespace hydroprint::worker
