#include "sim/velocity/film_mesh.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_mesh_criteria_2.h>
#include <CGAL/Delaunay_mesh_face_base_2.h>
#include <CGAL/Delaunay_mesher_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <deque>
#include <unordered_map>
#include <utility>

#include "sim/base/check.h"
#include "sim/velocity/curve_sampling.h"
#include "sim/velocity/quadratic_elements.h"

namespace hydroprint::velocity {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
using FaceBase = CGAL::Delaunay_mesh_face_base_2<Kernel>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, CGAL::Exact_predicates_tag>;
using Point = Kernel::Point_2;

constexpr double kSquaredSine = 0.25;  ///< squared sine of the smallest angle, 30 degrees

/// Triangles whose edges are all shorter than this are not refined for their angles. Otherwise,
/// gaps between waterlines that nearly touch would be filled with ever smaller triangles.
constexpr double kTiny_mm = 0.1;

/// A triangle is bad if an angle is below 30 degrees or its longest edge exceeds the sizing field.
class Criteria : public CGAL::Delaunay_mesh_criteria_2<Triangulation> {
  using Base = CGAL::Delaunay_mesh_criteria_2<Triangulation>;

 public:
  /// Squared sine of the smallest angle, and squared ratio of edge length to target size. The queue
  /// processes oversized triangles first.
  struct Quality {
    double sine2 = 1, size2 = 0;
    bool is_tiny = false;
    bool operator<(const Quality& other) const {
      if (size2 > 1 || other.size2 > 1) {
        return size2 != other.size2 ? size2 > other.size2 : sine2 < other.sine2;
      }
      return sine2 < other.sine2;
    }
  };

  class Is_bad {  // NOLINT(readability-identifier-naming): the name required by CGAL's concept
   public:
    using Quality = Criteria::Quality;
    explicit Is_bad(const Sizing* sizing) : sizing_(sizing) {}

    CGAL::Mesh_2::Face_badness operator()(const Quality& q) const {
      if (q.size2 > 1) return CGAL::Mesh_2::IMPERATIVELY_BAD;
      return q.sine2 < kSquaredSine && !q.is_tiny ? CGAL::Mesh_2::BAD : CGAL::Mesh_2::NOT_BAD;
    }

    CGAL::Mesh_2::Face_badness operator()(const Triangulation::Face_handle& face,
                                          Quality& quality) const {
      const Point& a = face->vertex(0)->point();
      const Point& b = face->vertex(1)->point();
      const Point& c = face->vertex(2)->point();
      std::array<double, 3> square = {CGAL::squared_distance(b, c), CGAL::squared_distance(c, a),
                                      CGAL::squared_distance(a, b)};
      std::sort(square.begin(), square.end());
      const double twice_area =
          (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
      quality.sine2 = twice_area * twice_area / (square[1] * square[2]);
      const double size = sizing_->at({(a.x() + b.x() + c.x()) / 3, (a.y() + b.y() + c.y()) / 3});
      quality.size2 = square[2] / (size * size);
      quality.is_tiny = square[2] < kTiny_mm * kTiny_mm;
      return (*this)(quality);
    }

   private:
    const Sizing* sizing_;
  };

  explicit Criteria(const Sizing* sizing) : Base(kSquaredSine), sizing_(sizing) {}
  [[nodiscard]] Is_bad is_bad_object() const { return Is_bad(sizing_); }

 private:
  const Sizing* sizing_;
};

void insert_loop(Triangulation& triangulation, const std::vector<Eigen::Vector2d>& loop) {
  std::vector<Triangulation::Vertex_handle> handles;
  handles.reserve(loop.size());
  Triangulation::Face_handle near;
  for (const Eigen::Vector2d& p : loop) {
    handles.push_back(triangulation.insert(Point(p.x(), p.y()), near));
    near = handles.back()->face();
  }
  for (std::size_t i = 0; i < handles.size(); ++i) {
    const auto& next = handles[(i + 1) % handles.size()];
    if (handles[i] != next) triangulation.insert_constraint(handles[i], next);
  }
}

/// Marks the faces surrounded by an odd number of curves as film.
void mark_film(Triangulation& triangulation) {
  for (auto face : triangulation.all_face_handles()) face->set_in_domain(false);
  CGAL::Unique_hash_map<Triangulation::Face_handle, int> nesting(-1);
  std::deque<Triangulation::Face_handle> border = {triangulation.infinite_face()};
  nesting[triangulation.infinite_face()] = 0;
  while (!border.empty()) {
    // Floods one level; faces behind its constraints belong to the next.
    const auto start = border.front();
    border.pop_front();
    std::vector<Triangulation::Face_handle> open = {start};
    const int level = nesting[start];
    while (!open.empty()) {
      const auto face = open.back();
      open.pop_back();
      face->set_in_domain(level % 2 == 1);
      for (int i = 0; i < 3; ++i) {
        const auto next = face->neighbor(i);
        if (nesting[next] != -1) continue;
        const bool wall = face->is_constrained(i);
        nesting[next] = wall ? level + 1 : level;
        if (wall) {
          border.push_back(next);
        } else {
          open.push_back(next);
        }
      }
    }
  }
}

bool lies_on(const std::vector<Eigen::Vector2d>& polygon, const Eigen::Vector2d& p) {
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Eigen::Vector2d along = polygon[i] - polygon[j];
    const double t = std::clamp((p - polygon[j]).dot(along) / along.squaredNorm(), 0.0, 1.0);
    if ((polygon[j] + t * along - p).squaredNorm() < 1e-12) return true;
  }
  return false;
}

/// Returns a limit far above the number of vertices that the sizes imply. Without this limit, the
/// mesher would divide edges forever where two waterlines touch.
std::size_t most_vertices(const film::Outline& outline,
                          const std::vector<std::vector<Eigen::Vector2d>>& waterlines,
                          const Sizing::Options& size) {
  constexpr double kBaseVertices = 50000, kPerPoint = 100, kPerCoarsest = 8;
  double points = 0;
  for (const auto& loop : waterlines) points += static_cast<double>(loop.size());
  const double coarsest = outline.size_mm().prod() / (size.most_mm * size.most_mm);
  return static_cast<std::size_t>(kBaseVertices + kPerPoint * points + kPerCoarsest * coarsest);
}

FilmMesh extract(const Triangulation& triangulation, const film::Outline& outline) {
  FilmMesh mesh;
  CGAL::Unique_hash_map<Triangulation::Vertex_handle, int> index(-1);
  std::unordered_map<std::uint64_t, int> edge_index;
  std::vector<char> sides;  // number of film triangles at each edge
  for (auto face : triangulation.finite_face_handles()) {
    if (!face->is_in_domain()) continue;
    Eigen::Vector3i corners, edges;
    for (int i = 0; i < 3; ++i) {
      const auto vertex = face->vertex(i);
      if (index[vertex] < 0) {
        index[vertex] = static_cast<int>(mesh.vertices_mm.size());
        mesh.vertices_mm.emplace_back(vertex->point().x(), vertex->point().y());
      }
      corners[i] = index[vertex];
    }
    for (int i = 0; i < 3; ++i) {
      const auto [a, b] = std::minmax(corners[(i + 1) % 3], corners[(i + 2) % 3]);
      const auto key = static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint32_t>(b);
      const auto [it, is_new] = edge_index.try_emplace(key, static_cast<int>(mesh.edges.size()));
      if (is_new) {
        mesh.edges.push_back({a, b});
        sides.push_back(0);
      }
      ++sides[it->second];
      edges[i] = it->second;
    }
    mesh.triangles.push_back(corners);
    mesh.triangle_edges.push_back(edges);
  }
  mesh.edge_kind.assign(mesh.edges.size(), EdgeKind::kInner);
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    if (sides[e] != 1) continue;
    const Eigen::Vector2d middle =
        0.5 * (mesh.vertices_mm[mesh.edges[e][0]] + mesh.vertices_mm[mesh.edges[e][1]]);
    mesh.edge_kind[e] = lies_on(outline.polygon, middle) ? EdgeKind::kVat : EdgeKind::kWaterline;
  }
  return mesh;
}

}  // namespace

Result<FilmMesh> mesh_film(const film::Outline& outline, const waterline::Waterline& line,
                           const MeshOptions& options) {
  HP_CHECK(line.bounds_film.size() == line.section.size());
  HP_CHECK(outline.polygon.size() >= 3);
  std::vector<std::vector<Eigen::Vector2d>> waterlines;
  for (std::size_t l = 0; l < line.section.size(); ++l) {
    if (!line.bounds_film[l]) continue;
    const auto& curve = line.section[l].points_mm;
    auto loop = sample_loop(curve, options.spacing_mm, options.tolerance_mm, options.least_mm);
    // A contour that is too small for sampling keeps its own corners.
    waterlines.push_back(loop.size() < 6 && curve.size() > loop.size() ? curve : std::move(loop));
  }
  const Sizing sizing(outline, waterlines, options.size);
  try {
    Triangulation triangulation;
    insert_loop(triangulation, outline.polygon);
    for (const auto& loop : waterlines) insert_loop(triangulation, loop);
    mark_film(triangulation);
    CGAL::Delaunay_mesher_2<Triangulation, Criteria> mesher(triangulation, Criteria(&sizing));
    mesher.init(true);
    const std::size_t most = most_vertices(outline, waterlines, options.size);
    while (mesher.step_by_step_refine_mesh()) {
      if (triangulation.number_of_vertices() > most) {
        return fail(Code::kInternal,
                    fmt::format("film mesh at immersion {:.2f} mm: needs more than {} vertices. "
                                "Smooth the model, or dip another part of it",
                                line.immersion_mm, most),
                    kMeshUnbounded);
      }
    }
    FilmMesh mesh = extract(triangulation, outline);
    mesh.elimination_order = elimination_order(mesh);
    return mesh;
  } catch (const std::exception& error) {
    return fail(Code::kInternal,
                fmt::format("film mesh at immersion {:.2f} mm: {}. Please report this",
                            line.immersion_mm, error.what()));
  }
}

}  // namespace hydroprint::velocity
