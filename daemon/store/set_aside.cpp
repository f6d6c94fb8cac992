#include "daemon/store/set_aside.h"

#include <fmt/format.h>

#include <array>
#include <ctime>
#include <system_error>

#include "daemon/platform/durable_file.h"
#include "daemon/platform/log.h"

namespace hydroprint::daemon {
namespace {

std::string time_text(std::int64_t unix_ms) {
  const auto time = static_cast<std::time_t>(unix_ms / 1000);
  std::tm parts{};
  ::gmtime_r(&time, &parts);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y%m%dT%H%M%SZ", &parts);
  return text.data();
}

/// Finds an unused folder name that begins with `name`.
std::filesystem::path unused_folder(const std::filesystem::path& parent, const std::string& name) {
  std::filesystem::path folder = parent / name;
  for (int i = 2; std::filesystem::exists(folder); ++i) {
    folder = parent / fmt::format("{}-{}", name, i);
  }
  return folder;
}

}  // namespace

std::filesystem::path new_set_aside(const Layout& layout, std::int64_t now_ms) {
  return unused_folder(layout.set_aside(), time_text(now_ms));
}

SetAside::SetAside(const Layout& layout, std::int64_t now_ms)
    : layout_(layout), folder_(new_set_aside(layout, now_ms)) {}

SetAside::~SetAside() {
  if (count_ == 0) return;
  log(LogLevel::kWarning, "files_set_aside",
      {{"count", count_},
       {"folder", folder_.string()},
       {"message",
        "these files are not in the database. If the database was lost, or replaced by an older "
        "copy, stop the daemon and restore the right database; otherwise delete the folder"}});
}

Status SetAside::move(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error) && std::filesystem::is_empty(path, error)) {
    discard(path);
    return {};
  }
  const auto target = folder_ / path.lexically_relative(layout_.root);
  HP_RETURN_IF_ERROR(make_folder(target.parent_path()));
  HP_RETURN_IF_ERROR(publish(path, target));
  ++count_;
  return {};
}

}  // namespace hydroprint::daemon
