#include "daemon/config/executable_path.h"

#include <unistd.h>

#include <sstream>

namespace hydroprint::daemon {
namespace {

namespace fs = std::filesystem;

// Resolves links, because the program's files are next to the file itself and not next to a link.
fs::path program_at(const fs::path& path) {
  std::error_code error;
  const fs::path file = fs::canonical(path, error);
  return !error && fs::is_regular_file(file, error) && ::access(file.c_str(), X_OK) == 0
             ? file
             : fs::path();
}

}  // namespace

fs::path own_program(const std::string& argv0, const std::string& search_path,
                     const fs::path& link) {
  std::error_code error;
  if (fs::path file = fs::read_symlink(link, error); !error) return file;
  return find_program(argv0, search_path);
}

fs::path find_program(const std::string& name, const std::string& search_path) {
  if (name.find('/') != std::string::npos) return program_at(name);
  std::istringstream folders(search_path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    fs::path file = program_at(fs::path(folder.empty() ? "." : folder) / name);
    if (!file.empty()) return file;
  }
  return {};
}

}  // namespace hydroprint::daemon
