#include "sim/velocity/refinement.h"

#include <CGAL/Delaunay_mesh_criteria_2.h>
#include <CGAL/Delaunay_mesher_2.h>

#include <algorithm>
#include <array>

namespace hydroprint::velocity {
namespace {

using Point = Kernel::Point_2;
using Vertex = Triangulation::Vertex_handle;
using Face = Triangulation::Face_handle;

constexpr double kSquaredSine = 0.25;  ///< squared sine of the smallest angle, 30 degrees

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

/// An edge of the film's border is divided if a vertex lies in its diametral circle, so that no
/// circumcentre of a triangle lies beyond it. This is also true of tiny edges that are not divided:
/// triangles whose circumcentre lies beyond them are tiny themselves, and are not refined.
struct IsConforming : CGAL::Mesh_2::Is_locally_conforming_Gabriel<Triangulation> {
  using Base = CGAL::Mesh_2::Is_locally_conforming_Gabriel<Triangulation>;

  bool operator()(const Triangulation& triangulation, const Face& face, int edge) const {
    return is_free(triangulation, face, edge) &&
           is_free(triangulation, face->neighbor(edge),
                   triangulation.tds().mirror_index(face, edge));
  }

  bool operator()(const Triangulation& triangulation, const Vertex& a, const Vertex& b) const {
    Face face;
    int edge = 0;
    triangulation.is_edge(a, b, face, edge);
    return (*this)(triangulation, face, edge);
  }

  bool operator()(const Triangulation& triangulation, const Face& face, int edge,
                  const Point& p) const {
    const Vertex& a = face->vertex(Triangulation::cw(edge));
    const Vertex& b = face->vertex(Triangulation::ccw(edge));
    return CGAL::squared_distance(a->point(), b->point()) < kTiny_mm * kTiny_mm ||
           Base::operator()(triangulation, a, b, p);
  }

 private:
  /// Returns true if the edge conforms to one of its faces.
  [[nodiscard]] bool is_free(const Triangulation& triangulation, const Face& face, int edge) const {
    return triangulation.is_infinite(face) || (!face->is_in_domain() && is_thin(face, edge)) ||
           (*this)(triangulation, face, edge, face->vertex(edge)->point());
  }

  static bool is_thin(const Face& face, int edge) {
    const Kernel::Line_2 line(face->vertex(Triangulation::cw(edge))->point(),
                              face->vertex(Triangulation::ccw(edge))->point());
    return CGAL::squared_distance(line, face->vertex(edge)->point()) < kTiny_mm * kTiny_mm;
  }
};

class EdgesBase
    : public CGAL::Mesh_2::Refine_edges_base_with_clusters<Triangulation, IsConforming> {
  using Base = CGAL::Mesh_2::Refine_edges_base_with_clusters<Triangulation, IsConforming>;

 public:
  using Base::Base;

  /// Marks the film around a new vertex, which CGAL does only after IsConforming has needed it.
  void after_insertion_impl(const Vertex& v) {
    Face right;
    int edge = 0;
    tr.is_edge(va, v, right, edge);
    bool is_film = visitor_mark_at_right;
    auto face = tr.incident_faces(v, right);  // counter-clockwise
    do {
      if (face->vertex(Triangulation::ccw(face->index(v))) == vb) is_film = visitor_mark_at_left;
      face->set_in_domain(is_film && !tr.is_infinite(face));
    } while (++face != right);
    Base::after_insertion_impl(v);
  }
};

/// CGAL::Delaunay_mesher_2 with another criterion for dividing edges.
class Mesher {
  using EdgeLevel =
      CGAL::Mesh_2::Refine_edges_with_clusters<Triangulation, IsConforming, EdgesBase>;
  using FaceLevel = CGAL::Mesh_2::Refine_faces<Triangulation, Criteria, EdgeLevel>;

 public:
  Mesher(Triangulation& triangulation, const Sizing& sizing)
      : criteria_(&sizing),
        clusters_(triangulation),
        edges_(triangulation, clusters_, no_level_),
        faces_(triangulation, criteria_, edges_),
        visitor_(faces_, edges_, no_visitor_) {
    clusters_.create_clusters();
    edges_.scan_triangulation();
    faces_.scan_triangulation();
  }

  /// @return false if nothing is left to refine
  bool insert_point() { return faces_.try_to_insert_one_point(visitor_); }

 private:
  Criteria criteria_;
  CGAL::Null_mesher_level no_level_;
  CGAL::Null_mesh_visitor no_visitor_;
  CGAL::Mesh_2::Clusters<Triangulation> clusters_;
  EdgeLevel edges_;
  FaceLevel faces_;
  CGAL::Mesh_2::Refine_edges_visitor_from_faces<FaceLevel> visitor_;
};

}  // namespace

bool refine(Triangulation& triangulation, const Sizing& sizing, std::size_t most) {
  Mesher mesher(triangulation, sizing);
  while (mesher.insert_point()) {
    if (triangulation.number_of_vertices() > most) return false;
  }
  return true;
}

}  // namespace hydroprint::velocity
