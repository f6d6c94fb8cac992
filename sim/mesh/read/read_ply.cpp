#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sim/mesh/read/colours.h"
#include "sim/mesh/read/file.h"
#include "sim/mesh/read/names.h"
#include "sim/mesh/read/numbers.h"
#include "sim/mesh/read/ply_body.h"
#include "sim/mesh/read/readers.h"
#include "sim/mesh/read/triangulate.h"

namespace hydroprint::mesh {
namespace {

/// What a property means here.
enum class Role { kX, kY, kZ, kRed, kGreen, kBlue, kU, kV, kTexture, kCorners, kUvList, kNone };
constexpr std::size_t kSingleNumbers = 9;  ///< roles before kCorners

constexpr std::size_t index_of(Role role) { return static_cast<std::size_t>(role); }

/// Names of colours and texture coordinates, the best first. All names of a set must occur.
using Names = std::vector<std::vector<std::string_view>>;

const Names& colour_names() {
  static const Names all = {
      {"red", "green", "blue"}, {"diffuse_red", "diffuse_green", "diffuse_blue"}, {"r", "g", "b"}};
  return all;
}

const Names& uv_names() {
  static const Names all = {{"u", "v"}, {"s", "t"}, {"texture_u", "texture_v"}, {"tx", "ty"}};
  return all;
}

bool names_a_colour(const std::string& name) {
  for (const std::string_view part : {"red", "rgb", "color", "colour"})
    if (name.find(part) != name.npos) return true;
  return false;
}

/// An element with the roles of its properties.
struct Layout {
  const PlyElement* element = nullptr;
  std::vector<Role> roles;

  [[nodiscard]] bool has(Role role) const { return std::ranges::count(roles, role) > 0; }
};

void assign(const std::vector<std::string_view>& names, Role first, Layout& layout) {
  const auto& properties = layout.element->properties;
  for (std::size_t p = 0; p < properties.size(); ++p)
    for (std::size_t k = 0; k < names.size(); ++k)
      if (properties[p].name == names[k] && !properties[p].count)
        layout.roles[p] = static_cast<Role>(index_of(first) + k);
}

void assign_best(const Names& candidates, Role first, Layout& layout) {
  for (const auto& names : candidates) {
    const bool complete = std::ranges::all_of(names, [&](std::string_view name) {
      return std::ranges::any_of(layout.element->properties,
                                 [&](const auto& p) { return p.name == name && !p.count; });
    });
    if (complete) return assign(names, first, layout);
  }
}

Layout layout_of(const PlyElement& element) {
  Layout layout{&element, std::vector<Role>(element.properties.size(), Role::kNone)};
  const bool is_vertex = element.name == "vertex";
  if (!is_vertex && element.name != "face") return layout;
  assign_best(colour_names(), Role::kRed, layout);
  if (is_vertex) {
    assign({"x", "y", "z"}, Role::kX, layout);
    assign_best(uv_names(), Role::kU, layout);
    return layout;
  }
  assign({"texnumber"}, Role::kTexture, layout);
  for (std::size_t p = 0; p < layout.roles.size(); ++p) {
    const auto& property = element.properties[p];
    if (is_corner_list(property)) layout.roles[p] = Role::kCorners;
    if (property.name == "texcoord" && property.count) layout.roles[p] = Role::kUvList;
  }
  return layout;
}

/// Numbers of one item by their roles.
struct Item {
  std::array<double, kSingleNumbers> values = {};
  std::vector<int> corners;
  std::vector<float> uvs;

  [[nodiscard]] double at(Role role) const { return values[index_of(role)]; }
  [[nodiscard]] Eigen::Vector3f colour() const {
    return Eigen::Vector3d(at(Role::kRed), at(Role::kGreen), at(Role::kBlue)).cast<float>();
  }
};

class PlyReader {
 public:
  PlyReader(const PlyHeader& header, std::string_view body, const std::filesystem::path& path)
      : header_(header), body_(body, header) {
    model_.path = path;
  }

  Result<Model> run(const Context& context) {
    add_materials();
    for (const auto& element : header_.elements) {
      const Layout layout = layout_of(element);
      if (element.name == "vertex") begin_vertices(layout);
      if (element.name == "face") begin_faces(layout);
      for (std::uint64_t i = 0; i < element.count; ++i) {
        if (i % 65536 == 0) HP_RETURN_IF_ERROR(check_cancelled(context));
        HP_RETURN_IF_ERROR(read_item(layout, i));
      }
    }
    finish();
    return std::move(model_);
  }

 private:
  [[nodiscard]] tl::unexpected<Error> bad(const Layout& layout, std::uint64_t item,
                                          std::string_view what) const {
    return damaged(model_.path, fmt::format("{} {}", layout.element->name, item), what);
  }

  void warn(WarningCode code, std::string message) {
    model_.warnings.push_back({code, std::move(message), {InFile{model_.path.string()}}});
  }

  /// One material for each texture, and a last one without for faces that name none.
  void add_materials() {
    for (const std::string& texture : header_.textures) {
      Material material;
      material.name = "TextureFile " + texture;
      material.texture = resolve_texture(model_.path.parent_path(), texture);
      model_.materials.push_back(std::move(material));
    }
    if (!model_.materials.empty()) model_.materials.emplace_back();
  }

  void begin_vertices(const Layout& layout) {
    model_.vertices.reserve(layout.element->count);
    vertex_uvs_ = layout.has(Role::kU);
    vertex_colours_ = layout.has(Role::kRed);
    note_colours(layout, vertex_colours_);
  }

  void begin_faces(const Layout& layout) {
    face_uvs_ = layout.has(Role::kUvList);
    face_colours_ = layout.has(Role::kRed);
    note_colours(layout, face_colours_);
    numbered_ = layout.has(Role::kTexture);
  }

  /// Notes properties that look like colours but were not understood.
  void note_colours(const Layout& layout, bool understood) {
    if (understood) return;
    for (const auto& property : layout.element->properties)
      if (names_a_colour(property.name))
        model_.not_understood.push_back(
            fmt::format("property {} of each {}", property.name, layout.element->name));
  }

  Status read_item(const Layout& layout, std::uint64_t i) {
    body_.next_item();
    item_.corners.clear();
    item_.uvs.clear();
    for (std::size_t p = 0; p < layout.roles.size(); ++p)
      HP_RETURN_IF_ERROR(read_property(layout, i, layout.element->properties[p], layout.roles[p]));
    if (layout.element->name == "vertex") return add_vertex(layout, i);
    if (layout.element->name == "face") add_face();
    return {};
  }

  Status read_property(const Layout& layout, std::uint64_t i, const PlyProperty& property,
                       Role role) {
    double count = 1;
    if (property.count) {
      const auto length = body_.next(*property.count);
      if (!length || !(*length >= 0)) return bad(layout, i, "is truncated");
      count = *length;
      if (role == Role::kCorners && count < 3)
        return bad(layout, i, "has fewer than three corners");
    }
    for (double k = 0; k < count; ++k) {
      const auto value = body_.next(property.type);
      if (!value)
        return bad(layout, i,
                   fmt::format("is truncated, or its {} is not a number", property.name));
      HP_RETURN_IF_ERROR(take(layout, i, property, role, *value));
    }
    return {};
  }

  Status take(const Layout& layout, std::uint64_t i, const PlyProperty& property, Role role,
              double value) {
    const auto vertices = static_cast<double>(model_.vertices.size());
    if (role == Role::kNone) return {};
    if (role == Role::kCorners) {
      if (!(value >= 0 && value < vertices))
        return bad(layout, i,
                   fmt::format("uses a vertex out of range (the file has {})", vertices));
      item_.corners.push_back(static_cast<int>(value));
      return {};
    }
    const bool is_colour = role == Role::kRed || role == Role::kGreen || role == Role::kBlue;
    if (!std::isfinite(value) && !is_colour)
      return bad(layout, i, fmt::format("its {} is not a finite number", property.name));
    if (role == Role::kUvList) {
      item_.uvs.push_back(static_cast<float>(value));
      return {};
    }
    const auto& type = property.type;
    const bool coded = is_colour && type.kind == PlyType::Kind::kUnsigned && type.bytes < 4;
    item_.values[index_of(role)] = coded ? value / (type.bytes == 1 ? 255 : 65535) : value;
    return {};
  }

  Status add_vertex(const Layout& layout, std::uint64_t i) {
    if (model_.vertices.size() > INT32_MAX - 1)
      return bad(layout, i, "there are too many vertices");
    model_.vertices.emplace_back(item_.at(Role::kX), item_.at(Role::kY), item_.at(Role::kZ));
    if (vertex_colours_) model_.vertex_colours.push_back(item_.colour());
    if (vertex_uvs_)
      uv_of_vertex_.push_back(
          Eigen::Vector2d(item_.at(Role::kU), item_.at(Role::kV)).cast<float>());
    return {};
  }

  void add_face() {
    const bool has_uvs = face_uvs_ ? item_.uvs.size() == 2 * item_.corners.size() : vertex_uvs_;
    const int material = has_uvs ? material_of_face() : static_cast<int>(header_.textures.size());
    for (const auto& t : triangulate(model_.vertices, item_.corners)) {
      Eigen::Vector3i triangle;
      std::array<Eigen::Vector2f, 3> uvs = {Eigen::Vector2f::Zero(), Eigen::Vector2f::Zero(),
                                            Eigen::Vector2f::Zero()};
      for (std::size_t k = 0; k < 3; ++k) {
        const auto corner = static_cast<std::size_t>(t[k]);
        triangle[static_cast<int>(k)] = item_.corners[corner];
        if (has_uvs) uvs[k] = uv_of(corner);
      }
      model_.triangles.push_back(triangle);
      if (face_uvs_ || vertex_uvs_) model_.corner_uvs.push_back(uvs);
      if (!model_.materials.empty()) model_.triangle_material.push_back(material);
      if (face_colours_) model_.triangle_colours.push_back(item_.colour());
    }
    if ((face_uvs_ || vertex_uvs_) && !has_uvs) ++without_uvs_;
  }

  [[nodiscard]] Eigen::Vector2f uv_of(std::size_t corner) const {
    if (face_uvs_) return {item_.uvs[2 * corner], item_.uvs[2 * corner + 1]};
    return uv_of_vertex_[static_cast<std::size_t>(item_.corners[corner])];
  }

  /// Returns the material of the item's texture number; the last one if it has no such texture.
  [[nodiscard]] int material_of_face() const {
    const auto count = static_cast<int>(header_.textures.size());
    if (!numbered_) return 0;
    const double number = item_.at(Role::kTexture);
    return number >= 0 && number < count ? static_cast<int>(number) : count;
  }

  void finish() {
    bring_to_unit(model_.vertex_colours, "vertices", model_.path, model_.warnings);
    bring_to_unit(model_.triangle_colours, "faces", model_.path, model_.warnings);
    if (without_uvs_ > 0)
      warn(WarningCode::FACES_WITHOUT_UV,
           fmt::format("{} faces have no texture coordinates: they have no texture", without_uvs_));
  }

  const PlyHeader& header_;
  PlyBody body_;
  Model model_;
  Item item_;
  std::vector<Eigen::Vector2f> uv_of_vertex_;
  bool vertex_uvs_ = false, vertex_colours_ = false;
  bool face_uvs_ = false, face_colours_ = false, numbered_ = false;
  std::size_t without_uvs_ = 0;
};

}  // namespace

Result<Model> read_ply(std::string bytes, const std::filesystem::path& path,
                       const Context& context) {
  bytes = without_byte_order_mark(std::move(bytes));
  std::string_view body = bytes;
  HP_ASSIGN_OR_RETURN(const PlyHeader header, parse_ply_header(body, path));
  return PlyReader(header, body, path).run(context);
}

}  // namespace hydroprint::mesh
