#include "sim/mesh/make_surface.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "sim/base/number_text.h"
#include "sim/mesh/coincident.h"
#include "sim/mesh/edges.h"
#include "sim/mesh/holes.h"
#include "sim/mesh/inner.h"
#include "sim/mesh/normals.h"
#include "sim/mesh/orient.h"
#include "sim/mesh/subdivide.h"
#include "sim/mesh/units.h"
#include "sim/mesh/weld.h"

namespace hydroprint::mesh {
namespace {

void warn(Surface& surface, const Model& model, WarningCode code, std::string message) {
  surface.warnings.push_back({code, std::move(message), {InFile{model.path.string()}}});
}

/// Returns the triangles that still have an area after coincident points are welded.
std::vector<int> proper_triangles(const Model& model, const std::vector<int>& weld,
                                  double tolerance) {
  std::vector<int> kept;
  kept.reserve(model.triangles.size());
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    std::array<Eigen::Vector3d, 3> p;
    std::array<int, 3> w{};
    for (std::size_t k = 0; k < 3; ++k) {
      w[k] = weld[static_cast<std::size_t>(model.triangles[t][static_cast<int>(k)])];
      p[k] = model.vertices[static_cast<std::size_t>(w[k])];
    }
    const bool distinct = w[0] != w[1] && w[1] != w[2] && w[2] != w[0];
    if (distinct && !is_degenerate(p[0], p[1], p[2], tolerance))
      kept.push_back(static_cast<int>(t));
  }
  return kept;
}

/// Drops faces that lie exactly on others, with a warning.
void drop_coincident(const Model& model, const std::vector<int>& weld, std::vector<int>& kept,
                     Surface& surface) {
  std::vector<Eigen::Vector3i> triangles;
  triangles.reserve(kept.size());
  for (const int t : kept) triangles.push_back(model.triangles[static_cast<std::size_t>(t)]);
  const DistinctFaces found = merge_coincident(triangles, weld);
  if (found.kept.size() == kept.size()) return;
  if (found.copies > 0)
    warn(surface, model, WarningCode::COINCIDENT_FACES,
         fmt::format("{} faces lie exactly on others, as in models exported twice or "
                     "double-sided; only the first of them is used",
                     found.copies));
  if (found.walls > 0)
    warn(surface, model, WarningCode::PARTS_TOUCH,
         fmt::format("{} faces divide parts that touch; the parts were united", found.walls));
  std::vector<int> left;
  left.reserve(found.kept.size());
  for (const int i : found.kept) left.push_back(kept[static_cast<std::size_t>(i)]);
  kept = std::move(left);
}

Patchwork start(const Model& model, std::vector<int> weld, const std::vector<int>& kept) {
  Patchwork work;
  work.points = model.vertices;
  work.weld = std::move(weld);
  work.source_triangle = kept;
  work.triangles.reserve(kept.size());
  for (const int t : kept) work.triangles.push_back(model.triangles[static_cast<std::size_t>(t)]);
  const std::array<Eigen::Vector3f, 3> whole = {Eigen::Vector3f::UnitX(), Eigen::Vector3f::UnitY(),
                                                Eigen::Vector3f::UnitZ()};
  work.source_barycentric.assign(kept.size(), whole);
  return work;
}

/// @return true if any triangle was flipped (which renumbers sides)
bool turn_over(Patchwork& work, const std::vector<bool>& flip) {
  bool any = false;
  for (std::size_t t = 0; t < flip.size(); ++t) {
    if (!flip[t]) continue;
    any = true;
    std::swap(work.triangles[t][1], work.triangles[t][2]);
    std::swap(work.source_barycentric[t][1], work.source_barycentric[t][2]);
  }
  return any;
}

void warn_about_size(const Model& model, Surface& surface) {
  Eigen::AlignedBox3d box;
  for (const auto& t : surface.triangles)
    for (int k = 0; k < 3; ++k) box.extend(surface.points[static_cast<std::size_t>(t[k])]);
  const double largest_mm = box.sizes().maxCoeff();
  if (!is_odd_size(largest_mm)) return;
  const auto unit = likely_unit(largest_mm / model.scale, model.path.extension().string());
  warn(surface, model, WarningCode::SMALL_OR_LARGE_OBJECT,
       fmt::format("the largest side is {} mm: {}", three_digits(largest_mm),
                   unit ? fmt::format("if the file is in {}, the scale is {}, and it is {} mm",
                                      unit->name, shortest_text(unit->mm),
                                      three_digits(largest_mm / model.scale * unit->mm))
                        : std::string("check the scale, the millimetres per unit of the model")));
}

void warn_about_orientation(const Model& model, const Orientation& found, Surface& surface) {
  if (found.inconsistent > 0 || found.one_sided > 0)
    warn(surface, model, WarningCode::INCONSISTENT_ORIENTATION,
         fmt::format("{} faces were turned over to agree with their neighbours; at {} edges, the "
                     "faces cannot be made to agree",
                     found.inconsistent, found.one_sided));
  if (found.inside_out > 0)
    warn(surface, model, WarningCode::INSIDE_OUT,
         fmt::format("{} of {} shells faced inward and were turned over", found.inside_out,
                     found.shells));
  if (found.shells > 1)
    warn(surface, model, WarningCode::MANY_SHELLS,
         fmt::format("the mesh has {} separate shells ({} of them cavities inside another shell); "
                     "their union is used",
                     found.shells, found.cavities));
}

std::string open_shells(std::size_t count) {
  return fmt::format("the outer side of {} open shell{}", count, count == 1 ? "" : "s");
}

void warn_about_sides(const Model& model, const Orientation& found, Surface& surface) {
  std::string message;
  if (found.by_rays > 0) message = open_shells(found.by_rays) + " was found by rays";
  if (found.undecided > 0)
    message += (message.empty() ? "" : "; ") + open_shells(found.undecided) +
               " is a guess, because rays did not decide. Close the holes in a 3D editor, or give "
               "sheets a thickness";
  if (!message.empty()) warn(surface, model, WarningCode::SIDES_BY_RAYS, std::move(message));
}

/// Names the place and the size of the largest holes.
std::string largest_holes(const std::vector<Hole>& holes) {
  constexpr std::size_t kNamed = 3;
  std::string out;
  for (std::size_t i = 0; i < std::min(kNamed, holes.size()); ++i) {
    // Adding zero turns -0.0 into 0.0.
    const Eigen::Array3d p = (10 * holes[i].middle_mm.array()).round() / 10 + 0.0;
    out += fmt::format("{}{} mm around ({:.1f}, {:.1f}, {:.1f}) mm", i == 0 ? "" : ", ",
                       three_digits(holes[i].length_mm), p.x(), p.y(), p.z());
  }
  return out + (holes.size() > kNamed ? ", ..." : "");
}

void warn_about_holes(const Model& model, const Edges& edges, const Patchwork& work,
                      Surface& surface) {
  const std::vector<Hole> holes = holes_of(work.points, work.weld, work.triangles, edges);
  if (holes.empty()) return;
  std::size_t open = 0;
  for (const Hole& hole : holes) open += hole.edges;
  warn(surface, model, WarningCode::MESH_OPEN,
       fmt::format("the mesh has {} boundary edges in {} hole{} ({}); they are closed by straight "
                   "lines at each waterline. Close large holes in a 3D editor",
                   open, holes.size(), holes.size() == 1 ? "" : "s", largest_holes(holes)));
}

/// @return true if every edge has two faces with opposite directions
bool check_edges(const Model& model, const Edges& edges, const Patchwork& work, Surface& surface) {
  std::size_t open = 0;
  std::size_t crowded = 0;
  std::size_t opposed = 0;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto sides = edges.sides(e);
    if (sides.size() == 1) {
      ++open;
    } else if (sides.size() > 2) {
      ++crowded;
    } else if (side_ends(sides[0], work.triangles, work.weld).from ==
               side_ends(sides[1], work.triangles, work.weld).from) {
      ++opposed;
    }
  }
  if (open > 0) warn_about_holes(model, edges, work, surface);
  if (crowded > 0)
    warn(surface, model, WarningCode::MESH_NON_MANIFOLD,
         fmt::format("{} edges have more than two faces: the outermost surface is used", crowded));
  return open + crowded + opposed == 0;
}

/// Returns whether parts share edges.
bool is_crowded(const Edges& edges) {
  for (std::size_t e = 0; e < edges.size(); ++e)
    if (edges.sides(e).size() > 2) return true;
  return false;
}

}  // namespace

Result<Surface> make_surface(const Model& model, double max_edge_mm, const Context& context) {
  const std::string name = model.path.string();
  if (!(max_edge_mm > 0))
    return fail(Code::kInvalidArgument, name + ": the longest edge allowed must be positive");
  context.progress("surface", 0);
  Surface surface;
  const double tolerance = nothing_mm(model.vertices);
  auto weld = weld_points(model.vertices, tolerance);
  auto kept = proper_triangles(model, weld, tolerance);
  if (kept.empty())
    return fail(Code::kInvalidArgument,
                name + ": all faces have zero area; export the model again");
  if (kept.size() < model.triangles.size())
    warn(surface, model, WarningCode::ZERO_AREA_FACES,
         fmt::format("{} faces whose corners coincide or lie on a line were dropped",
                     model.triangles.size() - kept.size()));
  drop_coincident(model, weld, kept, surface);
  Patchwork work = start(model, std::move(weld), kept);
  HP_RETURN_IF_ERROR(check_cancelled(context));

  Edges edges(work.triangles, work.weld);
  context.progress("surface", 0.3);
  HP_ASSIGN_OR_RETURN(Orientation orientation,
                      orient(work.points, work.weld, work.triangles, edges, context));
  if (turn_over(work, orientation.flip)) edges = Edges(work.triangles, work.weld);
  surface.closed = check_edges(model, edges, work, surface);
  surface.is_flat = orientation.is_flat;
  surface.shells = std::move(orientation.largest);
  warn_about_orientation(model, orientation, surface);
  warn_about_sides(model, orientation, surface);
  HP_RETURN_IF_ERROR(check_cancelled(context));

  context.progress("surface", 0.5);
  std::vector<Corners> solids;
  if (orientation.shells > 1 || is_crowded(edges))
    solids = closed_shells(work.points, work.triangles, edges);
  const auto before = work.triangles.size();
  auto subdivided = subdivide(std::move(work), max_edge_mm, kMaxSubdividedTriangles, context);
  if (!subdivided && subdivided.error().code == Code::kResourceExhausted)
    return fail(
        Code::kResourceExhausted,
        fmt::format(
            "{}: subdividing the faces to edges of {} mm would need {}; use a smaller scale", name,
            max_edge_mm, subdivided.error().message));
  if (!subdivided) return tl::unexpected(std::move(subdivided).error());
  work = std::move(*subdivided);
  if (work.triangles.size() != before) edges = Edges(work.triangles, work.weld);

  context.progress("surface", 0.8);
  HP_ASSIGN_OR_RETURN(surface.corner_normals,
                      corner_normals(work.points, work.triangles, work.weld, edges, context));
  surface.points = std::move(work.points);
  surface.triangles = std::move(work.triangles);
  surface.source_triangle = std::move(work.source_triangle);
  surface.source_barycentric = std::move(work.source_barycentric);
  surface.weld = std::move(work.weld);
  warn_about_size(model, surface);
  if (!solids.empty()) {
    HP_ASSIGN_OR_RETURN(surface.inner, inner_corners(surface, solids, context));
  }
  context.progress("surface", 1);
  return surface;
}

}  // namespace hydroprint::mesh
