#include "sim/worker/sha256.h"

#include <openssl/evp.h>

#include <array>
#include <memory>
#include <string_view>
#include <vector>

#include "sim/base/input_file.h"

namespace hydroprint::worker {
namespace {

constexpr std::size_t kChunkBytes = std::size_t{1} << 18;

struct FreeContext {
  void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
};

std::string hex(const unsigned char* bytes, std::size_t count) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string out;
  for (std::size_t i = 0; i < count; ++i) {
    out += kDigits[bytes[i] >> 4];
    out += kDigits[bytes[i] & 15];
  }
  return out;
}

}  // namespace

Result<Digest> digest_file(const std::filesystem::path& path) {
  HP_ASSIGN_OR_RETURN(std::ifstream file, open_input_file(path));
  const std::unique_ptr<EVP_MD_CTX, FreeContext> context(EVP_MD_CTX_new());
  bool ok = context && EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) == 1;
  Digest digest;
  std::vector<char> chunk(kChunkBytes);
  while (ok && file) {
    file.read(chunk.data(), static_cast<std::streamsize>(chunk.size()));
    const auto count = static_cast<std::size_t>(file.gcount());
    ok = EVP_DigestUpdate(context.get(), chunk.data(), count) == 1;
    digest.size_bytes += count;
  }
  std::array<unsigned char, EVP_MAX_MD_SIZE> bytes{};
  unsigned int size = 0;
  ok = ok && EVP_DigestFinal_ex(context.get(), bytes.data(), &size) == 1;
  if (!ok) return fail(Code::kInternal, path.string() + ": SHA-256 failed. Report this");
  if (file.bad()) return fail(Code::kDataLoss, path.string() + ": reading failed. Check the disk");
  digest.sha256 = hex(bytes.data(), size);
  return digest;
}

}  // namespace hydroprint::worker
