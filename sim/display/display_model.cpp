#include "sim/display/display_model.h"

#include <fmt/format.h>

#include <map>
#include <utility>

#include "sim/display/corners.h"
#include "sim/display/pictures.h"
#include "sim/display/thin.h"
#include "sim/mesh/weld.h"

namespace hydroprint::display {
namespace {

/// Returns a part without triangles for each ink, by its index.
std::map<int, Part> parts_of(const mesh::Model& model, const image::Paint& paint) {
  std::map<int, Part> out;
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    const auto [at, is_new] = out.try_emplace(paint.ink_index(t));
    if (!is_new) continue;
    if (const mesh::Material* material = model.material_of(t)) at->second.name = material->name;
    at->second.colour = paint.ink(t).colour;
    at->second.picture = paint.ink(t).texture;
  }
  return out;
}

void add_vertices(const CornerMesh& mesh, bool has_uvs, bool has_colours, DisplayModel& out) {
  out.places = mesh.place;
  for (const Corner& corner : mesh.corners) {
    out.positions.push_back(corner.position);
    if (has_uvs) out.uvs.push_back(corner.uv);
    if (has_colours) out.colours.push_back(corner.colour);
  }
}

void add_triangles(const CornerMesh& mesh, std::map<int, Part> parts, DisplayModel& out) {
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    parts.at(mesh.ink[i]).triangles.push_back(mesh.triangles[i]);
  for (auto& [ink, part] : parts) {
    if (!part.triangles.empty()) out.parts.push_back(std::move(part));
  }
}

Status add_pictures(const mesh::Model& model, const image::Paint& paint, const Context& context,
                    DisplayModel& out) {
  HP_ASSIGN_OR_RETURN(Pictures shown, show_pictures(paint.textures(), {}, context));
  out.pictures = std::move(shown.pictures);
  if (shown.halvings == 0) return {};
  out.warnings.push_back(
      {WarningCode::TEXTURES_REDUCED,
       fmt::format("the {} textures together are too large to show, so they are shown at 1/{} of "
                   "their resolution; what is printed has all of it",
                   paint.textures().size(), 1 << shown.halvings),
       {InFile{model.path.string()}}});
  return {};
}

}  // namespace

std::size_t DisplayModel::triangles() const {
  std::size_t sum = 0;
  for (const Part& part : parts) sum += part.triangles.size();
  return sum;
}

Result<mesh::Model> shown_shape(const mesh::Model& model, const Context& context) {
  const Eigen::Vector3d origin_mm = mesh::far_centre_mm(model.vertices);
  const image::Paint blank = image::blank_paint(model);
  HP_ASSIGN_OR_RETURN(const Thinned shown,
                      thin(find_corners(model, blank, origin_mm), kMostTriangles, context));
  mesh::Model out;
  out.path = model.path;
  out.scale = model.scale;
  out.vertices.resize(shown.mesh.places);
  const auto& corners = shown.mesh.corners;
  for (std::size_t i = 0; i < corners.size(); ++i)
    out.vertices[shown.mesh.place[i]] = origin_mm + corners[i].position.cast<double>();
  const auto place = [&](int corner) { return shown.mesh.place[corner]; };
  for (const Eigen::Vector3i& t : shown.mesh.triangles)
    out.triangles.emplace_back(place(t[0]), place(t[1]), place(t[2]));
  return out;
}

Result<DisplayModel> make_display(const mesh::Model& model, const image::Paint& paint,
                                  const Context& context) {
  DisplayModel out;
  out.origin_mm = mesh::far_centre_mm(model.vertices);
  HP_ASSIGN_OR_RETURN(const Thinned shown,
                      thin(find_corners(model, paint, out.origin_mm), kMostTriangles, context));
  const bool has_colours = !paint.vertex_colours().empty() || !paint.triangle_colours().empty();
  add_vertices(shown.mesh, !model.corner_uvs.empty(), has_colours, out);
  add_triangles(shown.mesh, parts_of(model, paint), out);
  if (shown.is_in_part) {
    out.warnings.push_back(
        {WarningCode::SHOWN_IN_PART,
         fmt::format("the model consists of very small pieces; the {} largest of its {} triangles "
                     "are shown, and all are printed",
                     out.triangles(), model.triangles.size()),
         {InFile{model.path.string()}}});
  }
  HP_RETURN_IF_ERROR(add_pictures(model, paint, context, out));
  return out;
}

}  // namespace hydroprint::display
