#include "sim/velocity/film_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <deque>
#include <unordered_map>
#include <utility>

#include "sim/base/check.h"
#include "sim/velocity/curve_sampling.h"
#include "sim/velocity/quadratic_elements.h"
#include "sim/velocity/refinement.h"

namespace hydroprint::velocity {
namespace {

using Point = Triangulation::Point;

/// Triangles with less than half this area, which lie between curves that touch, are left out. They
/// could make the matrix of the flow singular.
constexpr double kFlat_mm2 = 1e-12;

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

/// Returns a limit far above the number of vertices that the sizes imply.
std::size_t most_vertices(const film::Outline& outline,
                          const std::vector<std::vector<Eigen::Vector2d>>& waterlines,
                          const Sizing::Options& size) {
  constexpr double kBaseVertices = 50000, kPerPoint = 100, kPerCoarsest = 8;
  double points = 0;
  for (const auto& loop : waterlines) points += static_cast<double>(loop.size());
  const double coarsest = outline.size_mm().prod() / (size.most_mm * size.most_mm);
  return static_cast<std::size_t>(kBaseVertices + kPerPoint * points + kPerCoarsest * coarsest);
}

bool is_flat(const Triangulation::Face_handle& face) {
  const auto u = face->vertex(1)->point() - face->vertex(0)->point();
  const auto v = face->vertex(2)->point() - face->vertex(0)->point();
  return u.x() * v.y() - u.y() * v.x() < kFlat_mm2;
}

FilmMesh extract(const Triangulation& triangulation, const film::Outline& outline) {
  FilmMesh mesh;
  CGAL::Unique_hash_map<Triangulation::Vertex_handle, int> index(-1);
  std::unordered_map<std::uint64_t, int> edge_index;
  std::vector<char> sides;  // number of film triangles at each edge
  for (auto face : triangulation.finite_face_handles()) {
    if (!face->is_in_domain() || is_flat(face)) continue;
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
  HP_CHECK(options.size.at_waterline_mm > kTiny_mm);
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
    const std::size_t most = most_vertices(outline, waterlines, options.size);
    if (!refine(triangulation, sizing, most)) {
      return fail(Code::kInvalidArgument,
                  fmt::format("film mesh at immersion {:.2f} mm: needs more than {} vertices. "
                              "Smooth the model, or dip another part of it",
                              line.immersion_mm, most),
                  ErrorReason::MESH_UNBOUNDED);
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
