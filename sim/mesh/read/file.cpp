#include "sim/mesh/read/file.h"

#include <fmt/format.h>

#include <cstdint>
#include <fstream>
#include <system_error>

#include "sim/base/utf8.h"
#include "sim/mesh/read/read_model.h"

namespace hydroprint::mesh {
namespace {

constexpr std::uintmax_t kMaxBytes = std::uintmax_t{4} << 30;

}  // namespace

Result<std::string> read_file(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status))
    return fail(Code::kNotFound, path.string() + ": no such file; check the path");
  if (!std::filesystem::is_regular_file(status))
    return bad_input(path, "", "is not a regular file; use the path of a model");
  const auto size = std::filesystem::file_size(path, error);
  if (error || size == 0) return bad_input(path, "", "the file is empty; export it again");
  if (size > kMaxBytes)
    return bad_input(path, "", "the file is larger than 4 GiB; reduce the number of faces");
  std::string text(size, '\0');
  std::ifstream file(path, std::ios::binary);
  if (!file.read(text.data(), static_cast<std::streamsize>(size)))
    return fail(Code::kPermissionDenied,
                path.string() + ": cannot be read; check the permissions and the disk");
  return text;
}

std::string without_byte_order_mark(std::string text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  return text;
}

tl::unexpected<Error> bad_input(const std::filesystem::path& path, std::string_view place,
                                std::string_view what) {
  std::string message = path.string() + ": ";
  if (!place.empty()) message.append(place).append(": ");
  message += what;
  return fail(Code::kInvalidArgument, one_line(std::move(message)));
}

tl::unexpected<Error> damaged(const std::filesystem::path& path, std::string_view place,
                              std::string_view what) {
  return bad_input(path, place, fmt::format("{}; the file is damaged: export it again", what));
}

Status check_face_count(std::size_t faces, const std::filesystem::path& path) {
  if (faces == 0) return bad_input(path, "", "the file has no faces; export a mesh");
  if (faces > kMaxFaces)
    return bad_input(path, "",
                     fmt::format("has more than {} faces; simplify the model", kMaxFaces));
  return {};
}

}  // namespace hydroprint::mesh
