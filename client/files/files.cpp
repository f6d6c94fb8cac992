#include "client/files/files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <vector>

namespace hydroprint::client {
namespace {

constexpr std::streamsize kPieceBytes = std::streamsize{64} << 10;

tl::unexpected<Error> cannot_read(const std::filesystem::path& path, int error_number) {
  const Code code = error_number == EACCES ? Code::kPermissionDenied : Code::kNotFound;
  return fail(code, fmt::format("{}: cannot be read ({}); check the name and the permissions",
                                path.string(), std::strerror(error_number)));
}

}  // namespace

Status read_file(const std::filesystem::path& path, std::int64_t offset,
                 const std::function<bool(std::string_view)>& take) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) return cannot_read(path, error ? error.value() : ENOENT);
  if (!std::filesystem::is_regular_file(status))
    return fail(
        Code::kInvalidArgument,
        path.string() + ": not a regular file; give the path of a file, not of a folder or device");
  std::ifstream file(path, std::ios::binary);
  if (!file) return cannot_read(path, errno);
  file.seekg(offset);
  std::vector<char> piece(kPieceBytes);
  while (file) {
    file.read(piece.data(), kPieceBytes);
    const auto size = static_cast<std::size_t>(file.gcount());
    if (size > 0 && !take({piece.data(), size})) return {};
  }
  if (file.bad()) return cannot_read(path, EIO);
  return {};
}

Result<FileDigest> digest_file(const std::filesystem::path& path, const std::stop_token& stop) {
  Context context;
  context.cancelled = [&] { return stop.stop_requested(); };
  return hydroprint::digest_file(path, context);
}

Result<std::string> read_text(const std::filesystem::path& path, std::int64_t max_bytes) {
  std::string text;
  HP_RETURN_IF_ERROR(read_file(path, 0, [&](std::string_view bytes) {
    text += bytes;
    return std::ssize(text) <= max_bytes;
  }));
  if (std::ssize(text) > max_bytes)
    return fail(Code::kInvalidArgument,
                fmt::format("{}: longer than {} bytes; check the name", path.string(), max_bytes));
  return text;
}

}  // namespace hydroprint::client
