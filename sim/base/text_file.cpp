#include "sim/base/text_file.h"

#include <fstream>
#include <system_error>

namespace hydroprint {

Result<std::string> read_text_file(const std::filesystem::path& path, std::size_t max_bytes) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    return fail(Code::kNotFound, path.string() + ": no such file. Check the path");
  }
  if (!std::filesystem::is_regular_file(status)) {
    return fail(Code::kInvalidArgument, path.string() + ": not a regular file. Name a file");
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    return fail(Code::kPermissionDenied,
                path.string() + ": cannot be opened. Check its permissions");
  }
  // One byte more than allowed: the file may have grown since anyone asked for its size.
  std::string text(max_bytes + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (file.bad()) {
    return fail(Code::kDataLoss, path.string() + ": reading failed. Check the disk");
  }
  if (text.size() > max_bytes) {
    return fail(Code::kOutOfRange, path.string() + ": larger than " + std::to_string(max_bytes) +
                                       " bytes. Is it the right file?");
  }
  return text;
}

}  // namespace hydroprint
