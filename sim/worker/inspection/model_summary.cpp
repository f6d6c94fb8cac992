#include "sim/worker/inspection/model_summary.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <system_error>
#include <utility>

#include "proto/warning_message.h"
#include "sim/image/io/colour.h"
#include "sim/mesh/units.h"
#include "sim/worker/common/report.h"
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

/// Returns a file's name relative to the model's folder.
std::string name_beside(const mesh::Model& model, const std::filesystem::path& file) {
  return file.lexically_proximate(model.path.parent_path()).generic_string();
}

bool has_texture_file(const mesh::Material& material) {
  return !material.texture.empty() && material.texture_bytes.empty();
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
    if (material != nullptr && has_texture_file(*material))
      out.set_texture(name_beside(model, material->texture));
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

void add_materials(const mesh::Model& model, const image::Paint& paint, v1::ModelSummary& out) {
  std::map<std::pair<const mesh::Material*, int>, v1::ModelSummary::Material*> known;
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    const mesh::Material* material = model.material_of(t);
    auto& entry = known[{material, paint.ink_index(t)}];
    if (entry == nullptr) {
      entry = out.add_materials();
      if (material != nullptr) entry->set_name(material->name);
      set_colours(model, paint, t, material, *entry);
    }
    entry->set_triangles(entry->triangles() + 1);
  }
}

void add_companions(const mesh::Model& model, v1::ModelSummary& out) {
  std::map<std::string, bool> missing_by_name;
  for (const mesh::MaterialFile& file : model.material_files)
    missing_by_name.emplace(name_beside(model, file.path), file.is_missing);
  std::set<const mesh::Material*> used;
  for (std::size_t t = 0; t < model.triangles.size(); ++t) used.insert(model.material_of(t));
  std::error_code error;
  for (const mesh::Material* material : used) {
    if (material == nullptr || !has_texture_file(*material)) continue;
    missing_by_name.emplace(name_beside(model, material->texture),
                            !std::filesystem::is_regular_file(material->texture, error));
  }
  for (const auto& [name, is_missing] : missing_by_name) {
    v1::ModelSummary::Companion& companion = *out.add_companions();
    companion.set_name(name);
    companion.set_is_missing(is_missing);
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
  add_companions(model, out);
  add_all(model.not_understood, out.mutable_not_understood());
  out.set_shown_triangles(static_cast<std::int32_t>(shown.triangles()));
  for (const Warnings* warnings : {&model.warnings, &paint.warnings(), &shown.warnings})
    add_warnings(*warnings, *out.mutable_warnings());
  make_writable(out);
  return out;
}

}  // namespace hydroprint::worker
