#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

#include "sim/mesh/read/file.h"
#include "sim/mesh/read/numbers.h"
#include "sim/mesh/read/readers.h"
#include "sim/mesh/read/stl_colours.h"

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

tl::unexpected<Error> no_facets(const std::filesystem::path& path) {
  return bad_input(path, "", "the file has no facets; export a mesh");
}

/// Appends a triangle of the last three vertices.
void add_facet(Model& model) {
  const auto end = static_cast<int>(model.vertices.size());
  model.triangles.emplace_back(end - 3, end - 2, end - 1);
}

void take_colours(StlColours colours, Model& model) {
  if (colours.odd_attributes)
    model.not_understood.emplace_back(
        "attribute bytes of the facets, which are colours neither of Magics nor of VisCAM");
  if (colours.uncoloured > 0)
    model.warnings.push_back(
        {WarningCode::FACETS_WITHOUT_COLOUR,
         fmt::format("{} facets have no colour and stay white", colours.uncoloured),
         {InFile{model.path.string()}}});
  for (const auto& colour : colours.facets)
    model.vertex_colours.insert(model.vertex_colours.end(), 3, colour);
}

Result<Model> read_binary(std::string_view bytes, const std::filesystem::path& path,
                          const Context& context) {
  if (bytes.size() < kHeaderBytes) return damaged(path, "header", "the file is too short");
  const std::uint64_t facets = read_at<std::uint32_t>(bytes, 80);
  const std::uint64_t room = (bytes.size() - kHeaderBytes) / kFacetBytes;
  if (facets == 0) return no_facets(path);
  if (bytes.size() != kHeaderBytes + kFacetBytes * facets)
    return damaged(
        path, "header",
        fmt::format("announces {} facets, which does not match the file's size (room for {})",
                    facets, room));
  HP_RETURN_IF_ERROR(check_face_count(facets, path));
  Model model;
  model.path = path;
  model.vertices.reserve(3 * facets);
  std::vector<std::uint16_t> attributes;
  for (std::uint64_t f = 0; f < facets; ++f) {
    if (f % 65536 == 0) HP_RETURN_IF_ERROR(check_cancelled(context));
    const std::size_t at = kHeaderBytes + kFacetBytes * f;
    for (std::size_t corner = 1; corner < 4; ++corner) {  // 0 is the normal
      const auto value = [&](std::size_t k) {
        return read_at<float>(bytes, at + 12 * corner + 4 * k);
      };
      model.vertices.emplace_back(value(0), value(1), value(2));
      if (!model.vertices.back().allFinite())
        return damaged(path, fmt::format("facet {}", f), "a coordinate is not a finite number");
    }
    add_facet(model);
    attributes.push_back(read_at<std::uint16_t>(bytes, at + 48));
  }
  take_colours(stl_colours(bytes.substr(0, 80), attributes), model);
  return model;
}

/// Reads ASCII STL. Keywords may have any case, and "end solid" may be two words.
class AsciiReader {
 public:
  AsciiReader(std::string_view text, const std::filesystem::path& path) : rest_(text) {
    model_.path = path;
  }

  Result<Model> run(const Context& context) {
    bool closed = false;
    while (!rest_.empty()) {
      if (++line_ % 65536 == 0) HP_RETURN_IF_ERROR(check_cancelled(context));
      auto line = next_line(rest_);
      std::string keyword = lower_case(next_word(line));
      if (keyword.empty()) continue;
      if (keyword == "end") keyword += lower_case(next_word(line));
      closed = keyword == "endsolid";
      if (keyword == "vertex") HP_RETURN_IF_ERROR(read_vertex(line));
      if (keyword == "facet") HP_RETURN_IF_ERROR(check_closed());
      if (keyword != "endfacet") continue;
      if (corners_ != 3) return bad("the facet does not have three corners");
      corners_ = 0;
      add_facet(model_);
    }
    if (!closed) return bad("the file ends before \"endsolid\"");
    if (model_.triangles.empty()) return no_facets(model_.path);
    return std::move(model_);
  }

 private:
  [[nodiscard]] tl::unexpected<Error> bad(std::string_view what) const {
    return damaged(model_.path, fmt::format("line {}", line_), what);
  }

  Status check_closed() const {
    if (corners_ == 0) return {};
    return bad("the facet before this line is not closed by \"endfacet\"");
  }

  Status read_vertex(std::string_view line) {
    Eigen::Vector3d vertex;
    for (double& value : vertex) {
      const auto number = parse_number(next_word(line));
      if (!number) return bad("a vertex needs three finite numbers");
      value = *number;
    }
    if (!next_word(line).empty()) return bad("a vertex has more than three numbers");
    model_.vertices.push_back(vertex);
    ++corners_;
    return {};
  }

  std::string_view rest_;
  Model model_;
  std::size_t line_ = 0;
  int corners_ = 0;
};

/// Returns true if the file is binary. Binary files may begin with "solid" too, so the length
/// decides.
bool is_binary(std::string_view bytes) {
  if (bytes.size() >= kHeaderBytes &&
      bytes.size() == kHeaderBytes + kFacetBytes * std::uint64_t{read_at<std::uint32_t>(bytes, 80)})
    return true;
  if (bytes.substr(0, 1024).find('\0') != bytes.npos) return true;
  return lower_case(next_word(bytes, " \t\r\n")) != "solid";
}

}  // namespace

Result<Model> read_stl(std::string bytes, const std::filesystem::path& path,
                       const Context& context) {
  if (is_binary(bytes)) {
    std::string text = without_byte_order_mark(bytes);
    if (text.size() == bytes.size() || is_binary(text)) return read_binary(bytes, path, context);
    bytes = std::move(text);
  }
  return AsciiReader(bytes, path).run(context);
}

}  // namespace hydroprint::mesh
