#include "sim/mesh/read/ply_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <vector>

#include "sim/mesh/read/file.h"
#include "sim/mesh/read/numbers.h"

namespace hydroprint::mesh {
namespace {

enum class Kind { kSigned, kUnsigned, kReal };
struct Type {
  Kind kind = Kind::kReal;
  std::size_t bytes = 0;
};

const std::map<std::string_view, Type>& types() {
  static const std::map<std::string_view, Type> all = {
      {"char", {Kind::kSigned, 1}},     {"int8", {Kind::kSigned, 1}},
      {"uchar", {Kind::kUnsigned, 1}},  {"uint8", {Kind::kUnsigned, 1}},
      {"short", {Kind::kSigned, 2}},    {"int16", {Kind::kSigned, 2}},
      {"ushort", {Kind::kUnsigned, 2}}, {"uint16", {Kind::kUnsigned, 2}},
      {"int", {Kind::kSigned, 4}},      {"int32", {Kind::kSigned, 4}},
      {"uint", {Kind::kUnsigned, 4}},   {"uint32", {Kind::kUnsigned, 4}},
      {"float", {Kind::kReal, 4}},      {"float32", {Kind::kReal, 4}},
      {"double", {Kind::kReal, 8}},     {"float64", {Kind::kReal, 8}}};
  return all;
}

struct Property {
  std::string name;
  Type type;
  std::optional<Type> count;  ///< type of a list's length
  bool is_corners = false;    ///< the list of a face's vertices
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

class PlyChecker {
 public:
  PlyChecker(std::string_view bytes, const std::filesystem::path& path)
      : rest_(bytes), path_(path) {}

  Result<PlyFacts> run(const Context& context) {
    HP_RETURN_IF_ERROR(read_header());
    HP_RETURN_IF_ERROR(check_header());
    for (const auto& element : elements_) HP_RETURN_IF_ERROR(walk(element, context));
    return std::move(facts_);
  }

 private:
  enum class Format { kAscii, kLittle, kBig };

  [[nodiscard]] tl::unexpected<Error> bad_header(std::string_view what) const {
    return damaged(path_, fmt::format("header line {}", line_), what);
  }
  [[nodiscard]] tl::unexpected<Error> bad_item(const Element& element, std::uint64_t item,
                                               std::string_view what) const {
    return damaged(path_, fmt::format("{} {}", element.name, item), what);
  }

  std::string_view next_line() {
    const auto end = std::min(rest_.find('\n'), rest_.size());
    auto line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    ++line_;
    return line;
  }

  Status read_header() {
    if (next_line() != "ply") return bad_header("does not begin with \"ply\"");
    bool has_format = false;
    while (!rest_.empty() && line_ < 10000) {
      auto line = next_line();
      const auto keyword = next_word(line);
      if (keyword == "end_header") return has_format ? Status() : bad_header("no format is given");
      if (keyword == "format") {
        HP_RETURN_IF_ERROR(read_format(next_word(line)));
        has_format = true;
      } else if (keyword == "element") {
        HP_RETURN_IF_ERROR(read_element(line));
      } else if (keyword == "property") {
        HP_RETURN_IF_ERROR(read_property(line));
      } else if (keyword == "comment" && next_word(line) == "TextureFile") {
        facts_.texture = line.substr(std::min(line.find_first_not_of(" \t"), line.size()));
      }
    }
    return bad_header("the header has no end_header");
  }

  Status read_format(std::string_view word) {
    if (word == "ascii") {
      format_ = Format::kAscii;
    } else if (word == "binary_little_endian") {
      format_ = Format::kLittle;
    } else if (word == "binary_big_endian") {
      format_ = Format::kBig;
    } else {
      return bad_header("unknown format");
    }
    return {};
  }

  Status read_element(std::string_view line) {
    Element element;
    element.name = next_word(line);
    const auto word = next_word(line);
    const auto [end, error] =
        std::from_chars(word.data(), word.data() + word.size(), element.count);
    if (error != std::errc() || end != word.data() + word.size())
      return bad_header("the number of elements is malformed");
    elements_.push_back(std::move(element));
    return {};
  }

  Status read_property(std::string_view line) {
    if (elements_.empty()) return bad_header("a property comes before its element");
    Property property;
    auto word = next_word(line);
    if (word == "list") {
      const auto count = types().find(next_word(line));
      if (count == types().end() || count->second.kind == Kind::kReal)
        return bad_header("unknown type of a list's length");
      property.count = count->second;
      word = next_word(line);
    }
    const auto type = types().find(word);
    if (type == types().end()) return bad_header("unknown type");
    property.type = type->second;
    property.name = next_word(line);
    property.is_corners = elements_.back().name == "face" && property.count &&
                          (property.name == "vertex_indices" || property.name == "vertex_index");
    if (property.name == "texcoord" && property.count) facts_.has_face_uvs = true;
    elements_.back().properties.push_back(std::move(property));
    return {};
  }

  Status check_header() {
    const Element* vertex = nullptr;
    const Element* face = nullptr;
    for (const auto& element : elements_) {
      if (element.name == "vertex" && face == nullptr) vertex = &element;
      if (element.name == "face") face = &element;
      HP_RETURN_IF_ERROR(check_size(element));
    }
    if (vertex == nullptr) return bad_header("no vertices come before the faces");
    for (const std::string_view axis : {"x", "y", "z"})
      if (!has(*vertex, [&](const Property& p) {
            return p.name == axis && !p.count && p.type.kind == Kind::kReal;
          }))
        return bad_header("the vertices lack the floating-point property " + std::string(axis));
    if (face == nullptr || face->count == 0)
      return bad_input(path_, "header", "the file has no faces; export a mesh, not a point cloud");
    if (!has(*face, [](const Property& p) { return p.is_corners && p.type.kind != Kind::kReal; }))
      return bad_header("the faces lack a list vertex_indices");
    facts_.vertices = vertex->count;
    facts_.faces = face->count;
    return {};
  }

  template <class Predicate>
  static bool has(const Element& element, Predicate predicate) {
    return std::any_of(element.properties.begin(), element.properties.end(), predicate);
  }

  /// Checks that the file is large enough for the stated number of items, before any is read.
  Status check_size(const Element& element) {
    std::uint64_t least = 0;
    for (const auto& p : element.properties)
      least += format_ == Format::kAscii ? 2 : p.count ? p.count->bytes : p.type.bytes;
    least = std::max<std::uint64_t>(least, 1);
    if (element.count <= (rest_.size() + 1) / least) return {};
    return damaged(path_, "header",
                   fmt::format("announces {} elements \"{}\", more than the file has room for",
                               element.count, element.name));
  }

  Status walk(const Element& element, const Context& context) {
    for (std::uint64_t i = 0; i < element.count; ++i) {
      if (i % 65536 == 0) HP_RETURN_IF_ERROR(check_cancelled(context));
      if (format_ == Format::kAscii) item_ = next_line();
      for (const auto& property : element.properties)
        HP_RETURN_IF_ERROR(walk(element, i, property));
    }
    return {};
  }

  Status walk(const Element& element, std::uint64_t item, const Property& property) {
    double count = 1;
    if (property.count) {
      const auto length = next(*property.count);
      if (!length || *length < 0) return bad_item(element, item, "is truncated");
      count = *length;
      if (property.is_corners && count < 3)
        return bad_item(element, item, "has fewer than three corners");
    }
    for (double k = 0; k < count; ++k) {
      const auto value = next(property.type);
      if (!value)
        return bad_item(element, item,
                        "is truncated or contains a value that is not a finite number");
      if (property.is_corners && !(*value >= 0 && *value < static_cast<double>(facts_.vertices)))
        return bad_item(
            element, item,
            fmt::format("uses a vertex out of range (the file has {})", facts_.vertices));
    }
    return {};
  }

  /// Returns the next number; nullopt if it is missing or not finite.
  std::optional<double> next(const Type& type) {
    if (format_ == Format::kAscii) return parse_number(next_word(item_));
    if (rest_.size() < type.bytes) return std::nullopt;
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < type.bytes; ++i) {
      const auto from = format_ == Format::kLittle ? type.bytes - 1 - i : i;
      bits = bits << 8 | static_cast<unsigned char>(rest_[from]);
    }
    rest_.remove_prefix(type.bytes);
    const double value = decode(bits, type);
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
  }

  static double decode(std::uint64_t bits, const Type& type) {
    if (type.kind == Kind::kReal && type.bytes == 4)
      return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
    if (type.kind == Kind::kReal) return std::bit_cast<double>(bits);
    if (type.kind == Kind::kUnsigned) return static_cast<double>(bits);
    const auto shift = 64 - 8 * type.bytes;
    return static_cast<double>(static_cast<std::int64_t>(bits << shift) >> shift);
  }

  std::string_view rest_;
  std::string_view item_;  ///< the rest of an ASCII item's line
  const std::filesystem::path& path_;
  Format format_ = Format::kAscii;
  std::size_t line_ = 0;
  std::vector<Element> elements_;
  PlyFacts facts_;
};

}  // namespace

Result<PlyFacts> check_ply(std::string_view bytes, const std::filesystem::path& path,
                           const Context& context) {
  return PlyChecker(bytes, path).run(context);
}

}  // namespace hydroprint::mesh
