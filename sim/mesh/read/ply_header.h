#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/base/result.h"

namespace hydroprint::mesh {

/// A number type of PLY.
struct PlyType {
  enum class Kind { kSigned, kUnsigned, kReal };
  Kind kind = Kind::kReal;
  std::size_t bytes = 0;
};

/// A property of each item of an element.
struct PlyProperty {
  std::string name;
  PlyType type;
  std::optional<PlyType> count;  ///< type of a list's length; nullopt: a single number
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  enum class Format { kAscii, kLittle, kBig };
  Format format = Format::kAscii;
  char line_end = '\n';  ///< last byte of each line of the header
  std::vector<PlyElement> elements;
  std::vector<std::string> textures;  ///< of lines `comment TextureFile NAME`
};

/// Parses a PLY header, removes it from the front of `bytes`, and checks that the rest has room for
/// the announced items, so that memory can be reserved for them. Errors are kInvalidArgument and
/// name the line: malformed lines, unknown types, no vertices with x, y and z before the faces, no
/// faces with a list vertex_indices (or vertex_index), more items than the file has room for.
[[nodiscard]] Result<PlyHeader> parse_ply_header(std::string_view& bytes,
                                                 const std::filesystem::path& path);

/// Returns true for the property that lists the vertices of a face.
[[nodiscard]] bool is_corner_list(const PlyProperty& property);

}  // namespace hydroprint::mesh
