#include "client/cli/program/credentials.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <toml++/toml.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <sstream>

namespace hydroprint::cli {
namespace {

std::filesystem::path folder_in(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr && *value == '/' ? value : "";
}

Status cannot_keep_key(const std::filesystem::path& file) {
  return fail(Code::kPermissionDenied,
              fmt::format("{}: cannot store the key: {}; set XDG_CONFIG_HOME to a folder "
                          "that you can write to",
                          file.string(), std::strerror(errno)));
}

Result<toml::table> read_credentials() {
  const auto file = credentials_file();
  struct stat info {};
  if (::stat(file.c_str(), &info) != 0) return toml::table();
  if ((info.st_mode & 077) != 0) {
    return fail(Code::kPermissionDenied, file.string() +
                                             ": other users can read the keys in this file; run "
                                             "chmod 600 on it, and create new keys");
  }
  try {
    return toml::parse_file(file.string());
  } catch (const toml::parse_error& error) {
    return fail(Code::kInvalidArgument,
                fmt::format("{}: not valid TOML ({}); correct or delete the file", file.string(),
                            error.description()));
  }
}

Status write_credentials(const toml::table& table) {
  const auto file = credentials_file();
  std::error_code ignored;  // writing the file reports the error
  std::filesystem::create_directories(file.parent_path(), ignored);
  const auto part = fmt::format("{}.{}", file.string(), ::getpid());
  ::unlink(part.c_str());
  const int descriptor = ::open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (descriptor < 0) return cannot_keep_key(file);
  std::ostringstream text;
  text << "# API keys of hydroprint, by the daemon's address.\n" << table << "\n";
  const std::string bytes = text.str();
  const auto written = ::write(descriptor, bytes.data(), bytes.size());
  if (::close(descriptor) != 0 || written != std::ssize(bytes) ||
      ::rename(part.c_str(), file.c_str()) != 0) {
    return cannot_keep_key(file);
  }
  return {};
}

}  // namespace

std::filesystem::path credentials_file() {
  auto folder = folder_in("XDG_CONFIG_HOME");
  if (folder.empty()) folder = folder_in("HOME") / ".config";
  return folder / "hydroprint" / "credentials.toml";
}

Result<std::string> kept_key(const std::string& server) {
  HP_ASSIGN_OR_RETURN(const toml::table table, read_credentials());
  const auto* const entry = table.get_as<toml::table>(server);
  if (entry == nullptr) return std::string();
  return entry->get("api_key") == nullptr ? "" : entry->get("api_key")->value_or(std::string());
}

Status keep_key(const std::string& server, const std::string& key) {
  HP_ASSIGN_OR_RETURN(toml::table table, read_credentials());
  if (key.empty()) {
    table.erase(server);
  } else {
    table.insert_or_assign(server, toml::table{{"api_key", key}});
  }
  return write_credentials(table);
}

}  // namespace hydroprint::cli
