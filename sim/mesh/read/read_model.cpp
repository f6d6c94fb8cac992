#include "sim/mesh/read/read_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>
#include <utility>

#include "sim/mesh/read/file.h"
#include "sim/mesh/read/readers.h"
#include "sim/mesh/weld.h"

namespace hydroprint::mesh {
namespace {

constexpr double kMinScale = 1e-6;
constexpr double kMaxScale = 1e6;
constexpr double kMaxCoordinateMm = 1e6;

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
    if (v.cwiseAbs().maxCoeff() > kMaxCoordinateMm)
      return bad_input(model.path, fmt::format("vertex {}", i),
                       "lies more than 1 km from the origin; give a smaller --scale");
  }
  for (const auto& uvs : model.corner_uvs)
    for (const auto& uv : uvs)
      if (!uv.allFinite())
        return damaged(model.path, "", "a texture coordinate is not a finite number");
  return {};
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
  const double tolerance = kNothing * diagonal(model.vertices);
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
  model.warnings.push_back({"zero_area_faces",
                            fmt::format("{} faces without area were dropped", dropped),
                            model.path.string()});
  return {};
}

}  // namespace

Result<Model> read_model(const std::filesystem::path& path, double scale, const Context& context) {
  if (!(scale > kMinScale && scale < kMaxScale))
    return fail(Code::kOutOfRange, path.string() +
                                       ": the scale must lie between 1e-6 and 1e6; set "
                                       "--scale to the millimetres per unit of the model");
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
  HP_RETURN_IF_ERROR(scale_vertices(model, scale));
  HP_RETURN_IF_ERROR(drop_degenerate(model));
  context.progress("reading", 1);
  return model;
}

}  // namespace hydroprint::mesh
