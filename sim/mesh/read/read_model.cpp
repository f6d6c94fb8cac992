#include "sim/mesh/read/read_model.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "sim/base/number_text.h"
#include "sim/mesh/read/file.h"
#include "sim/mesh/read/names.h"
#include "sim/mesh/read/readers.h"
#include "sim/mesh/weld.h"

namespace hydroprint::mesh {
namespace {

constexpr double kMinScale = 1e-6;
constexpr double kMaxScale = 1e6;
constexpr double kMaxExtent_mm = 1e6;
constexpr double kMaxDistance_mm = 1e10;  // a double's step there is 2e-6 mm

using Reader = Result<Model> (*)(std::string, const std::filesystem::path&, const Context&);

Reader reader_for(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (ending == ".obj") return read_obj;
  if (ending == ".stl") return read_stl;
  if (ending == ".ply") return read_ply;
  if (ending == ".gltf" || ending == ".glb") return read_gltf;
  return nullptr;
}

Status scale_vertices(Model& model, double scale) {
  for (std::size_t i = 0; i < model.vertices.size(); ++i) {
    auto& v = model.vertices[i];
    v *= scale;
    if (!v.allFinite())
      return damaged(model.path, fmt::format("vertex {}", i),
                     "a coordinate is not a finite number");
  }
  for (const auto& uvs : model.corner_uvs)
    for (const auto& uv : uvs)
      if (!uv.allFinite())
        return damaged(model.path, "", "a texture coordinate is not a finite number");
  return {};
}

/// Refuses objects that are too large, or too far from the origin for the precision of doubles, and
/// warns of those that lie far from it, such as scans in map coordinates.
Status check_place(Model& model) {
  Eigen::AlignedBox3d box;
  for (const auto& v : model.vertices) box.extend(v);
  const Eigen::Vector3d centre = box.center();
  const double largest_mm = box.sizes().maxCoeff();
  if (largest_mm > kMaxExtent_mm) {
    const auto furthest = std::ranges::max_element(
        model.vertices, {}, [&](const auto& v) { return (v - model.vertices.front()).norm(); });
    return bad_input(
        model.path, fmt::format("vertex {}", std::distance(model.vertices.begin(), furthest)),
        "lies more than 1 km from the first vertex; remove it if it is a stray one, or "
        "use a smaller scale");
  }
  if (centre.norm() > kMaxDistance_mm)
    return bad_input(model.path, "",
                     "lies more than 10,000 km from the origin; move the model to the origin");
  if (far_centre_mm(model.vertices).isZero()) return {};
  model.warnings.push_back(
      {WarningCode::FAR_FROM_ORIGIN,
       fmt::format("the model lies {} m from the origin, around ({:.3f}, {:.3f}, {:.3f}) mm, as "
                   "scans in map coordinates do; poses refer to the origin of the file",
                   three_digits(centre.norm() / 1000), centre.x(), centre.y(), centre.z()),
       {InFile{model.path.string()}}});
  return {};
}

/// Returns the marker by which a texture's name stands for many tiles; empty if it has none.
std::string_view tile_marker(std::string_view name) {
  for (const std::string_view marker : {"<UDIM>", "<UVTILE>", "%(UDIM)d", "<udim>", "<uvtile>"})
    if (name.find(marker) != name.npos) return marker;
  return {};
}

/// Settles the files of the materials' textures. A name that differs from that of an existing file
/// only in case or Unicode form means that file.
void settle_textures(Model& model) {
  std::map<std::filesystem::path, std::optional<std::filesystem::path>> similar;
  std::error_code error;
  for (auto& material : model.materials) {
    if (material.texture.empty() || !material.texture_bytes.empty()) continue;
    const std::string name = material.texture.filename().string();
    if (!tile_marker(name).empty()) {
      model.not_understood.push_back(
          fmt::format("material \"{}\": texture {} in UDIM tiles (make one material for each tile, "
                      "or bake the tiles into one texture)",
                      material.name, name));
      material.texture.clear();
      material.has_colour = false;
    } else if (!std::filesystem::exists(material.texture, error)) {
      const auto [known, is_new] = similar.try_emplace(material.texture);
      if (is_new) known->second = similar_file(material.texture, model.path.parent_path());
      if (!known->second) continue;
      if (is_new)
        model.warnings.push_back(similar_name(material.texture, *known->second, model.path));
      material.texture = *known->second;
    }
  }
}

Status check_indices(const Model& model) {
  const int count = static_cast<int>(model.vertices.size());
  for (std::size_t t = 0; t < model.triangles.size(); ++t)
    if (model.triangles[t].minCoeff() < 0 || model.triangles[t].maxCoeff() >= count)
      return damaged(model.path, fmt::format("triangle {}", t),
                     fmt::format("uses a vertex out of range (the file has {})", count));
  return {};
}

/// Removes the entries of `values` whose triangle is dropped.
template <class T>
void keep(std::vector<T>& values, const std::vector<bool>& kept) {
  if (values.empty()) return;
  std::size_t n = 0;
  for (std::size_t i = 0; i < kept.size(); ++i)
    if (kept[i]) values[n++] = values[i];
  values.resize(n);
}

Status drop_degenerate(Model& model) {
  const double tolerance = nothing_mm(model.vertices);
  std::vector<bool> kept(model.triangles.size());
  std::size_t dropped = 0;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const auto& t = model.triangles[i];
    const auto corner = [&](int k) { return model.vertices[static_cast<std::size_t>(t[k])]; };
    kept[i] = !is_degenerate(corner(0), corner(1), corner(2), tolerance);
    dropped += kept[i] ? 0 : 1;
  }
  if (dropped == kept.size())
    return damaged(model.path, "", fmt::format("all {} faces have zero area", dropped));
  if (dropped == 0) return {};
  keep(model.triangles, kept);
  keep(model.corner_uvs, kept);
  keep(model.triangle_material, kept);
  keep(model.triangle_colours, kept);
  model.warnings.push_back({WarningCode::ZERO_AREA_FACES,
                            fmt::format("{} faces without area were dropped", dropped),
                            {InFile{model.path.string()}}});
  return {};
}

}  // namespace

Result<Model> read_model(const std::filesystem::path& path, double scale, const Context& context) {
  if (!(scale > kMinScale && scale < kMaxScale))
    return fail(Code::kOutOfRange, path.string() +
                                       ": the scale must lie between 1e-6 and 1e6; set "
                                       "it to the millimetres per unit of the model");
  const Reader reader = reader_for(path);
  if (reader == nullptr)
    return bad_input(path, "", "unknown format; use an OBJ, STL, PLY, glTF or GLB file");
  context.progress("reading", 0);
  HP_ASSIGN_OR_RETURN(std::string bytes, read_file(path));
  HP_RETURN_IF_ERROR(check_cancelled(context));
  HP_ASSIGN_OR_RETURN(Model model, reader(std::move(bytes), path, context));
  HP_RETURN_IF_ERROR(check_cancelled(context));
  context.progress("reading", 0.8);
  HP_RETURN_IF_ERROR(check_face_count(model.triangles.size(), path));
  HP_RETURN_IF_ERROR(check_indices(model));
  model.scale = scale;
  HP_RETURN_IF_ERROR(scale_vertices(model, scale));
  HP_RETURN_IF_ERROR(check_place(model));
  HP_RETURN_IF_ERROR(drop_degenerate(model));
  settle_textures(model);
  context.progress("reading", 1);
  return model;
}

}  // namespace hydroprint::mesh
