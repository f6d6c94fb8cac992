#include "sim/mesh/read/ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "sim/mesh/read/file.h"
#include "sim/mesh/read/numbers.h"

namespace hydroprint::mesh {
namespace {

using Kind = PlyType::Kind;

const std::map<std::string_view, PlyType>& ply_types() {
  static const std::map<std::string_view, PlyType> all = {
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

class PlyHeaderParser {
 public:
  PlyHeaderParser(std::string_view bytes, const std::filesystem::path& path)
      : rest_(bytes), path_(path) {}

  Result<PlyHeader> run() {
    find_line_end();
    HP_RETURN_IF_ERROR(read_lines());
    HP_RETURN_IF_ERROR(check());
    return std::move(header_);
  }

  [[nodiscard]] std::string_view rest() const { return rest_; }

 private:
  [[nodiscard]] tl::unexpected<Error> bad(std::string_view what) const {
    return damaged(path_, fmt::format("header line {}", line_), what);
  }

  /// Files of old Macintosh programs end lines with CR alone.
  void find_line_end() {
    const auto first = rest_.find_first_of("\r\n");
    if (first == rest_.npos || rest_[first] == '\n') return;
    if (!rest_.substr(first).starts_with("\r\n")) header_.line_end = '\r';
  }

  std::string_view take_line() {
    const auto end = std::min(rest_.find(header_.line_end), rest_.size());
    auto line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    ++line_;
    return line;
  }

  Status read_lines() {
    if (trimmed(take_line()) != "ply") return bad("does not begin with \"ply\"");
    bool has_format = false;
    while (!rest_.empty() && line_ < 10000) {
      auto line = take_line();
      const auto keyword = next_word(line);
      if (keyword == "end_header") return has_format ? Status() : bad("no format is given");
      if (keyword == "format") {
        HP_RETURN_IF_ERROR(read_format(next_word(line)));
        has_format = true;
      } else if (keyword == "element") {
        HP_RETURN_IF_ERROR(read_element(line));
      } else if (keyword == "property") {
        HP_RETURN_IF_ERROR(read_property(line));
      } else if (keyword == "comment" && lower_case(next_word(line)) == "texturefile") {
        header_.textures.push_back(trimmed(line));
      }
    }
    return bad("the header has no end_header");
  }

  Status read_format(std::string_view word) {
    if (word == "ascii") {
      header_.format = PlyHeader::Format::kAscii;
    } else if (word == "binary_little_endian") {
      header_.format = PlyHeader::Format::kLittle;
    } else if (word == "binary_big_endian") {
      header_.format = PlyHeader::Format::kBig;
    } else {
      return bad("unknown format");
    }
    return {};
  }

  Status read_element(std::string_view line) {
    PlyElement element;
    element.name = next_word(line);
    const auto word = next_word(line);
    const auto [end, error] =
        std::from_chars(word.data(), word.data() + word.size(), element.count);
    if (error != std::errc() || end != word.data() + word.size())
      return bad("the number of elements is malformed");
    header_.elements.push_back(std::move(element));
    return {};
  }

  Status read_property(std::string_view line) {
    if (header_.elements.empty()) return bad("a property comes before its element");
    PlyProperty property;
    auto word = next_word(line);
    if (word == "list") {
      const auto count = ply_types().find(next_word(line));
      if (count == ply_types().end() || count->second.kind == Kind::kReal)
        return bad("unknown type of a list's length");
      property.count = count->second;
      word = next_word(line);
    }
    const auto type = ply_types().find(word);
    if (type == ply_types().end()) return bad("unknown type");
    property.type = type->second;
    property.name = next_word(line);
    header_.elements.back().properties.push_back(std::move(property));
    return {};
  }

  Status check() {
    const PlyElement* vertex = nullptr;
    const PlyElement* face = nullptr;
    for (const auto& element : header_.elements) {
      if (element.name == "vertex" && face == nullptr) vertex = &element;
      if (element.name == "face") face = &element;
      HP_RETURN_IF_ERROR(check_size(element));
    }
    if (vertex == nullptr) return bad("no vertices come before the faces");
    for (const std::string_view axis : {"x", "y", "z"})
      if (std::ranges::none_of(vertex->properties,
                               [&](const PlyProperty& p) { return p.name == axis && !p.count; }))
        return bad("the vertices lack the property " + std::string(axis));
    if (face == nullptr || face->count == 0)
      return bad_input(path_, "header", "the file has no faces; export a mesh, not a point cloud");
    if (std::ranges::none_of(face->properties, is_corner_list))
      return bad("the faces lack a list vertex_indices");
    return check_face_count(face->count, path_);
  }

  /// Checks that the file is large enough for the stated number of items, before any is read.
  Status check_size(const PlyElement& element) {
    std::uint64_t least = 0;
    for (const auto& p : element.properties)
      least += header_.format == PlyHeader::Format::kAscii ? 2
               : p.count                                   ? p.count->bytes
                                                           : p.type.bytes;
    least = std::max<std::uint64_t>(least, 1);
    if (element.count <= (rest_.size() + 1) / least) return {};
    return damaged(path_, "header",
                   fmt::format("announces {} elements \"{}\", more than the file has room for",
                               element.count, element.name));
  }

  std::string_view rest_;
  const std::filesystem::path& path_;
  std::size_t line_ = 0;
  PlyHeader header_;
};

}  // namespace

bool is_corner_list(const PlyProperty& property) {
  return property.count && property.type.kind != Kind::kReal &&
         (property.name == "vertex_indices" || property.name == "vertex_index");
}

Result<PlyHeader> parse_ply_header(std::string_view& bytes, const std::filesystem::path& path) {
  PlyHeaderParser parser(bytes, path);
  auto header = parser.run();
  bytes = parser.rest();
  return header;
}

}  // namespace hydroprint::mesh
