#include "daemon/store/artifact_files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>

#include "daemon/platform/durable_file.h"
#include "daemon/platform/resource_names.h"

namespace hydroprint::daemon {
namespace {

constexpr std::size_t kMostArtifacts = 1000;
constexpr const char* kNotPlain = "something other than regular files with plain names";

tl::unexpected<Error> unusable(const std::string& what) {
  return fail(
      Code::kInternal,
      "the worker's output contains " + what + "; check that workers.program is hydroprint-worker",
      ErrorReason::WORKER_UNUSABLE);
}

// Copies a regular file that has one name, up to its present size.
Status copy_plain_file(const std::filesystem::path& from, const std::filesystem::path& to) {
  HP_ASSIGN_OR_RETURN(const UniqueFd source, open_file(from, O_RDONLY | O_NONBLOCK));
  struct stat info {};
  if (::fstat(source.get(), &info) != 0 || !S_ISREG(info.st_mode) || info.st_nlink != 1) {
    return unusable(kNotPlain);
  }
  return copy_bytes(source, info.st_size, to);
}

}  // namespace

Status copy_output(const std::filesystem::path& from, const std::filesystem::path& to) {
  discard(to);
  HP_RETURN_IF_ERROR(make_folder(to));
  std::error_code error;
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(from, error)) {
    if (++files > kMostArtifacts) return unusable("too many files");
    const std::string name = entry.path().filename().string();
    if (!check_file_name("artifact", name) || entry.is_symlink(error)) return unusable(kNotPlain);
    HP_RETURN_IF_ERROR(copy_plain_file(entry.path(), to / name));
  }
  return error ? Status(unusable("no artifacts")) : Status();
}

std::string media_type(const std::string& name) {
  static constexpr std::array<std::array<const char*, 2>, 12> kTypes{{
      {".png", "image/png"},
      {".pdf", "application/pdf"},
      {".json", "application/json"},
      {".html", "text/html"},
      {".ply", "model/ply"},
      {".exr", "image/x-exr"},
      {".tif", "image/tiff"},
      {".tiff", "image/tiff"},
      {".csv", "text/csv"},
      {".txt", "text/plain"},
      {".toml", "application/toml"},
      {".obj", "model/obj"},
  }};
  for (const auto& [extension, type] : kTypes) {
    if (name.ends_with(extension)) return type;
  }
  return "application/octet-stream";
}

Status lay_out_inputs(const Layout& layout, const std::vector<InputFile>& inputs,
                      const std::filesystem::path& folder, const std::stop_token& stop) {
  discard(folder);
  HP_RETURN_IF_ERROR(make_folder(folder));
  for (const InputFile& input : inputs) {
    const auto asset = layout.asset(input.sha256);
    if (!std::filesystem::exists(asset)) {
      return fail(Code::kFailedPrecondition,
                  input.name + ": assets/" + input.sha256 + " is missing; upload the file again",
                  ErrorReason::ASSET_MISSING);
    }
    HP_RETURN_IF_ERROR(make_folder((folder / input.name).parent_path()));
    HP_RETURN_IF_ERROR(link_or_copy(asset, folder / input.name, stop));
  }
  return {};
}

Result<std::vector<Artifact>> publish_artifacts(const std::filesystem::path& from,
                                                const std::filesystem::path& to) {
  std::vector<Artifact> artifacts;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(from, error)) {
    const std::string name = entry.path().filename().string();
    struct stat info {};
    const bool plain = ::lstat(entry.path().c_str(), &info) == 0 && S_ISREG(info.st_mode) &&
                       info.st_nlink == 1 && check_file_name("artifact", name);
    if (!plain) return unusable(kNotPlain);
    if (artifacts.size() == kMostArtifacts) return unusable("too many files");
    HP_ASSIGN_OR_RETURN(std::string hash, sha256_of_file(entry.path()));
    HP_RETURN_IF_ERROR(sync_path(entry.path()));
    artifacts.push_back({name, info.st_size, std::move(hash), media_type(name)});
  }
  if (error || artifacts.empty()) return unusable("no artifacts");
  std::sort(artifacts.begin(), artifacts.end(),
            [](const Artifact& a, const Artifact& b) { return a.name < b.name; });
  HP_RETURN_IF_ERROR(sync_path(from));
  discard(to);
  HP_RETURN_IF_ERROR(publish(from, to));
  return artifacts;
}

}  // namespace hydroprint::daemon
