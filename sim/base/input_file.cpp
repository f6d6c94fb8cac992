#include "sim/base/input_file.h"

#include <fmt/format.h>

#include <array>
#include <system_error>

#include "sim/base/number_text.h"

namespace hydroprint {

Result<std::ifstream> open_input_file(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    return fail(Code::kNotFound, path.string() + ": no such file. Check the path");
  }
  if (!std::filesystem::is_regular_file(status)) {
    return fail(
        Code::kInvalidArgument,
        path.string() + ": not a regular file. Give the path of a file, not of a folder or device");
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    return fail(Code::kPermissionDenied,
                path.string() + ": cannot be opened. Check its permissions");
  }
  return file;
}

Result<std::string> read_text_file(const std::filesystem::path& path, std::size_t max_bytes) {
  HP_ASSIGN_OR_RETURN(std::ifstream file, open_input_file(path));
  // Reads to the end instead of querying the size, because the file may grow, and some files report
  // no size.
  std::string text;
  std::array<char, 1 << 16> chunk;
  while (text.size() <= max_bytes && file) {
    file.read(chunk.data(), chunk.size());
    text.append(chunk.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad()) {
    return fail(Code::kDataLoss, path.string() + ": reading failed. Check the disk");
  }
  if (text.size() > max_bytes) {
    return fail(Code::kOutOfRange,
                fmt::format("{}: larger than {}. Check that it is the right file", path.string(),
                            format_bytes(static_cast<std::int64_t>(max_bytes))));
  }
  return text;
}

}  // namespace hydroprint
