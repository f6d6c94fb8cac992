#include "client/cli/rig_session/lease_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>

namespace hydroprint::cli {
namespace {

std::filesystem::path variable(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr && *value == '/' ? value : "";
}

std::filesystem::path folder() {
  if (const auto runtime = variable("XDG_RUNTIME_DIR"); !runtime.empty())
    return runtime / "hydroprint";
  if (const auto state = variable("XDG_STATE_HOME"); !state.empty()) return state / "hydroprint";
  return variable("HOME") / ".local/state/hydroprint";
}

Status cannot_keep(const std::filesystem::path& file) {
  return fail(Code::kPermissionDenied,
              fmt::format("{}: cannot store the lease: {}; set XDG_RUNTIME_DIR to a "
                          "folder that you can write to",
                          file.string(), std::strerror(errno)));
}

bool write_new(const std::filesystem::path& file, const std::string& text) {
  ::unlink(file.c_str());
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (descriptor < 0) return false;
  const auto written = ::write(descriptor, text.data(), text.size());
  return ::close(descriptor) == 0 && written == std::ssize(text);
}

}  // namespace

std::filesystem::path lease_file(const std::string& server) {
  std::string name = "lease-" + server;
  std::replace_if(
      name.begin(), name.end(),
      [](unsigned char c) { return std::isalnum(c) == 0 && c != '.' && c != '-'; }, '_');
  return folder() / name;
}

Status keep_lease(const std::string& server, const std::string& lease_id) {
  const auto file = lease_file(server);
  std::error_code ignored;  // writing the file reports the error
  std::filesystem::create_directories(file.parent_path(), ignored);
  ::chmod(file.parent_path().c_str(), 0700);
  const auto part = fmt::format("{}.{}", file.string(), ::getpid());
  if (!write_new(part, lease_id + "\n") || ::rename(part.c_str(), file.c_str()) != 0)
    return cannot_keep(file);
  return {};
}

std::optional<std::string> kept_lease(const std::string& server) {
  std::ifstream file(lease_file(server));
  std::string lease_id;
  if (!std::getline(file, lease_id) || lease_id.empty()) return std::nullopt;
  return lease_id;
}

void forget_lease(const std::string& server, const std::string& lease_id) {
  if (kept_lease(server) == lease_id) ::unlink(lease_file(server).c_str());
}

}  // namespace hydroprint::cli
