#include "sim/mesh/read/stl_check.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>

#include "sim/mesh/read/file.h"
#include "sim/mesh/read/numbers.h"

namespace hydroprint::mesh {
namespace {

constexpr std::size_t kHeaderBytes = 84;
constexpr std::size_t kFacetBytes = 50;

static_assert(std::endian::native == std::endian::little, "STL numbers are copied as they are");

template <class T>
T read_at(std::string_view bytes, std::size_t at) {
  T value{};
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

Result<std::size_t> check_binary(std::string_view bytes, const std::filesystem::path& path) {
  if (bytes.size() < kHeaderBytes) return damaged(path, "header", "the file is too short");
  const std::uint64_t facets = read_at<std::uint32_t>(bytes, 80);
  const std::uint64_t room = (bytes.size() - kHeaderBytes) / kFacetBytes;
  if (facets == 0) return bad_input(path, "header", "the file has no facets; export a mesh");
  if (bytes.size() != kHeaderBytes + kFacetBytes * facets)
    return damaged(
        path, "header",
        fmt::format("announces {} facets, which does not match the file's size (room for {})",
                    facets, room));
  for (std::uint64_t f = 0; f < facets; ++f)
    for (std::size_t k = 3; k < 12; ++k)
      if (!std::isfinite(read_at<float>(bytes, kHeaderBytes + kFacetBytes * f + 4 * k)))
        return damaged(path, fmt::format("facet {}", f), "a coordinate is not a finite number");
  return facets;
}

class AsciiChecker {
 public:
  AsciiChecker(std::string_view text, const std::filesystem::path& path)
      : rest_(text), path_(path) {}

  Result<std::size_t> run(const Context& context) {
    std::size_t facets = 0;
    bool closed = false;
    while (!rest_.empty()) {
      if (++line_ % 65536 == 0) HP_RETURN_IF_ERROR(check_cancelled(context));
      auto line = next_line();
      const auto keyword = next_word(line);
      if (keyword.empty()) continue;
      closed = keyword == "endsolid";
      if (keyword == "vertex") HP_RETURN_IF_ERROR(check_vertex(line));
      if (keyword == "facet") corners_ = 0;
      if (keyword != "endfacet") continue;
      if (corners_ != 3) return bad("the facet does not have three corners");
      corners_ = 0;
      ++facets;
    }
    if (!closed) return bad("the file ends before \"endsolid\"");
    if (facets == 0) return bad_input(path_, "", "the file has no facets; export a mesh");
    return facets;
  }

 private:
  [[nodiscard]] tl::unexpected<Error> bad(std::string_view what) const {
    return damaged(path_, fmt::format("line {}", line_), what);
  }

  std::string_view next_line() {
    const auto end = std::min(rest_.find('\n'), rest_.size());
    auto line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }

  Status check_vertex(std::string_view line) {
    for (int k = 0; k < 3; ++k)
      if (!parse_number(next_word(line))) return bad("a vertex needs three finite numbers");
    if (!next_word(line).empty()) return bad("a vertex has more than three numbers");
    ++corners_;
    return {};
  }

  std::string_view rest_;
  const std::filesystem::path& path_;
  std::size_t line_ = 0;
  int corners_ = 0;
};

/// Returns true if the file is binary. Binary files may begin with "solid" too, so the length
/// decides.
bool is_binary(std::string_view bytes) {
  if (bytes.size() >= kHeaderBytes &&
      bytes.size() == kHeaderBytes + kFacetBytes * std::uint64_t{read_at<std::uint32_t>(bytes, 80)})
    return true;
  return !bytes.starts_with("solid") || bytes.substr(0, 1024).find('\0') != bytes.npos;
}

}  // namespace

Result<std::size_t> check_stl(std::string_view bytes, const std::filesystem::path& path,
                              const Context& context) {
  return is_binary(bytes) ? check_binary(bytes, path) : AsciiChecker(bytes, path).run(context);
}

}  // namespace hydroprint::mesh
