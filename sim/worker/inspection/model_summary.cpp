#include "sim/worker/inspection/model_summary.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <map>
#include <string>
#include <utility>

#include "sim/image/io/colour.h"
#include "sim/mesh/units.h"
#include "sim/worker/common/report_values.h"

namespace hydroprint::worker {
namespace {

std::string format_of(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  if (ending == ".GLTF") return "glTF";
  return ending.empty() ? ending : ending.substr(1);
}

std::string hex(const Eigen::Vector3f& linear) {
  return fmt::format("#{:02x}{:02x}{:02x}", image::srgb8_from_linear(linear.x()),
                     image::srgb8_from_linear(linear.y()), image::srgb8_from_linear(linear.z()));
}

/// Returns the texture's file as the model's folder names it; empty for a texture in the model.
std::string texture_name(const mesh::Model& model, const mesh::Material& material) {
  if (!material.texture_bytes.empty()) return {};
  return utf8(material.texture.lexically_proximate(model.path.parent_path()).generic_string());
}

void set_colours(const mesh::Model& model, const image::Paint& paint, std::size_t triangle,
                 const mesh::Material* material, v1::ModelSummary::Material& out) {
  const image::Paint::Ink& ink = paint.ink(triangle);
  if (!ink.is_known) return;
  if (ink.texture >= 0) {
    const image::Texture& texture = paint.textures()[ink.texture];
    out.add_colour_sources(v1::ModelSummary::TEXTURE);
    out.set_texture_width_px(texture.width());
    out.set_texture_height_px(texture.height());
    if (material != nullptr) out.set_texture(texture_name(model, *material));
  }
  if (ink.of_surface) {
    out.add_colour_sources(paint.vertex_colours().empty() ? v1::ModelSummary::TRIANGLE_COLOURS
                                                          : v1::ModelSummary::VERTEX_COLOURS);
  }
  const bool is_factor = ink.texture >= 0 || ink.of_surface;
  if (is_factor && ink.colour.isOnes()) return;
  out.add_colour_sources(v1::ModelSummary::MATERIAL_COLOUR);
  out.set_colour(hex(ink.colour));
}

const mesh::Material* material_of(const mesh::Model& model, std::size_t triangle) {
  const int m = triangle < model.triangle_material.size() ? model.triangle_material[triangle] : -1;
  const bool is_known = m >= 0 && static_cast<std::size_t>(m) < model.materials.size();
  return is_known ? &model.materials[m] : nullptr;
}

void add_materials(const mesh::Model& model, const image::Paint& paint, v1::ModelSummary& out) {
  std::map<std::pair<const mesh::Material*, int>, v1::ModelSummary::Material*> known;
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    const mesh::Material* material = material_of(model, t);
    auto& entry = known[{material, paint.ink_index(t)}];
    if (entry == nullptr) {
      entry = out.add_materials();
      if (material != nullptr) entry->set_name(utf8(material->name));
      set_colours(model, paint, t, material, *entry);
    }
    entry->set_triangles(entry->triangles() + 1);
  }
}

void set_extents(const mesh::Model& model, v1::ModelSummary& out) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3i& triangle : model.triangles) {
    for (const int corner : triangle) box.extend(model.vertices[corner]);
  }
  for (int axis = 0; axis < 3; ++axis) {
    out.add_lowest_mm(box.min()[axis]);
    out.add_highest_mm(box.max()[axis]);
  }
  const double longest_mm = box.sizes().maxCoeff();
  if (!mesh::is_odd_size(longest_mm)) return;
  const auto unit = mesh::likely_unit(longest_mm / model.scale, model.path.extension().string());
  if (!unit) return;
  out.mutable_likely_unit()->set_name(std::string(unit->name));
  out.mutable_likely_unit()->set_mm(unit->mm);
}

}  // namespace

v1::ModelSummary summary_of(const mesh::Model& model, const image::Paint& paint,
                            const display::DisplayModel& shown) {
  v1::ModelSummary out;
  out.set_format(format_of(model.path));
  out.set_scale(model.scale);
  out.set_vertices(static_cast<std::int32_t>(model.vertices.size()));
  out.set_triangles(static_cast<std::int32_t>(model.triangles.size()));
  set_extents(model, out);
  out.set_has_texture_coordinates(!model.corner_uvs.empty());
  out.set_has_colour(paint.has_colour());
  add_materials(model, paint, out);
  for (const std::string& phrase : model.not_understood) out.add_not_understood(utf8(phrase));
  out.set_shown_triangles(static_cast<std::int32_t>(shown.triangles()));
  for (const Warnings* warnings : {&model.warnings, &paint.warnings(), &shown.warnings}) {
    for (const Warning& warning : *warnings) set_warning(warning, *out.add_warnings());
  }
  return out;
}

}  // namespace hydroprint::worker
