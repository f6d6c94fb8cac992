#include "sim/base/file_digest.h"

#include <vector>

#include "sim/base/input_file.h"
#include "sim/base/sha256.h"

namespace hydroprint {
namespace {

constexpr std::size_t kChunkBytes = std::size_t{1} << 18;

}  // namespace

Result<FileDigest> digest_file(const std::filesystem::path& path, const Context& context) {
  HP_ASSIGN_OR_RETURN(std::ifstream file, open_input_file(path));
  Sha256 hash;
  FileDigest digest;
  std::vector<char> chunk(kChunkBytes);
  while (file) {
    HP_RETURN_IF_ERROR(check_cancelled(context));
    file.read(chunk.data(), static_cast<std::streamsize>(chunk.size()));
    hash.add({chunk.data(), static_cast<std::size_t>(file.gcount())});
    digest.size_bytes += file.gcount();
  }
  if (file.bad()) return fail(Code::kDataLoss, path.string() + ": reading failed. Check the disk");
  digest.sha256 = hash.finish();
  return digest;
}

}  // namespace hydroprint
