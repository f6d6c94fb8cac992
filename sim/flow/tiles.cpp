#include "sim/flow/tiles.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/base/check.h"
#include "sim/flow/edge_table.h"
#include "sim/flow/jacobian.h"

namespace hydroprint::flow {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
/// If a level has more edges than this, reached and unreached points are scattered, and further
/// division does not resolve them.
constexpr std::size_t kMostEdges = 400000;
/// After this many levels, a 2 mm edge is shorter than a pixel; slivers could be divided without
/// end.
constexpr int kMostLevels = 6;
/// Most edges that are traced in all levels: half a minute of processor time with 400 waterlines.
constexpr std::size_t kMostTraced = 800000;
/// Where that limit ends the division, deviations up to this one are accepted.
constexpr double kCoarse_mm = 0.25;

/// A corner of tiles: its place on the surface and the film point that lands there (NaN: none).
struct Node {
  Vector3d surface_mm;
  Vector2d film_mm;
};

struct Tile {
  int triangle;
  double film_per_surface;  ///< upper bound of the length on the film per length on the surface
  std::array<int, 3> node;
  std::array<Vector3d, 3> barycentric;
};

/// Maps displacements on the film to displacements on the surface.
using SurfacePerFilm = Eigen::Matrix<double, 3, 2>;

/// State of the edge between two nodes.
enum class EdgeState : unsigned char { kLinear, kDivided, kBroken };

struct Edge {
  int a, b;
  Landing middle = {};
  double film_per_surface = 0;
  Vector2d film_mm = Vector2d::Constant(kNaN);
  /// One map for each of the tiles on the two sides of the edge.
  std::array<SurfacePerFilm, 2> side = {SurfacePerFilm::Zero(), SurfacePerFilm::Zero()};
  int sides = 0;

  /// Returns the distance on the surface that corresponds to `off_mm` on the film; the larger of
  /// those on the two sides of the edge.
  [[nodiscard]] double off_on_surface_mm(const Vector2d& off_mm) const {
    double most = 0;
    for (int i = 0; i < sides; ++i) most = std::max(most, (side[i] * off_mm).norm());
    return most;
  }
};

bool is_reached(const Node& node) { return !std::isnan(node.film_mm.x()); }

class Tiler {
 public:
  Tiler(const waterline::Body& body, const DipField& dip, const Landings& landings,
        const std::vector<Vector2d>& film_mm, const MapOptions& options)
      : body_(body),
        dip_(dip),
        landings_(landings),
        options_(options),
        tolerance_mm_(options.tolerance_mm) {
    nodes_.reserve(film_mm.size());
    for (std::size_t v = 0; v < film_mm.size(); ++v) {
      nodes_.push_back({body.points_mm[v], film_mm[v]});
    }
    const auto gradient = point_gradients(film_mm, body.points_mm, body.triangles);
    for (int t = 0; t < static_cast<int>(body.triangles.size()); ++t) {
      const Eigen::Vector3i& v = body.triangles[t];
      if (!is_reached(nodes_[v[0]]) && !is_reached(nodes_[v[1]]) && !is_reached(nodes_[v[2]])) {
        continue;
      }
      double film_per_surface = 0;
      for (const int n : v) {
        const double least = stretch_of(gradient[n]).least;  // NaN: not known
        film_per_surface = std::max(film_per_surface, std::isnan(least) ? 0 : 1 / least);
      }
      active_.push_back({t,
                         film_per_surface > 0 ? film_per_surface : 1,
                         {v[0], v[1], v[2]},
                         {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()}});
    }
    state_ = EdgeTable<EdgeState>(3 * active_.size() / 2);
    trust_smooth_edges(gradient);
  }

  Status run(const Context& context) {
    while (!active_.empty()) {
      std::vector<Edge> edges = untested_edges();
      HP_RETURN_IF_ERROR(trace_middles(edges, context));
      judge(edges);
      divide();
      // In a smooth map, the deviation on half an edge is four times smaller. A deviation that
      // division does not reduce is either a jump, which is large, or scatter of the traced points,
      // which is small.
      tolerance_mm_ *= 2;
      ++level_;
    }
    return {};
  }

  Tiles take() { return {std::move(done_), is_limited_}; }

 private:
  /// Marks edges of the mesh itself as linear if the map along them deviates from a straight line
  /// by less than half the tolerance. The deviation is estimated at the middle of a cubic through
  /// the gradients at both ends.
  void trust_smooth_edges(const std::vector<Gradient>& gradient) {
    for (const Tile& tile : active_) {
      for (int i = 0; i < 3; ++i) {
        const int a = tile.node[(i + 1) % 3];
        const int b = tile.node[(i + 2) % 3];
        if (!is_reached(nodes_[a]) || !is_reached(nodes_[b])) continue;
        const Vector3d along = nodes_[b].surface_mm - nodes_[a].surface_mm;
        const double bow_mm = ((gradient[a] - gradient[b]) * along).norm() / 8;
        if (bow_mm < 0.5 * options_.tolerance_mm) state_.set(a, b, EdgeState::kLinear);
      }
    }
  }

  std::vector<Edge> untested_edges() {
    std::vector<Edge> edges;
    EdgeTable<std::size_t> index;
    for (const Tile& tile : active_) {
      for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        const int k = (i + 2) % 3;
        const int a = tile.node[j], b = tile.node[k];
        if (state_.find(a, b) != nullptr) continue;
        const std::size_t* known = index.find(a, b);
        const bool is_new = known == nullptr;
        const std::size_t at = is_new ? edges.size() : *known;
        if (is_new) {
          index.set(a, b, at);
          edges.push_back({a, b});
        }
        Edge& edge = edges[at];
        const Landing landing =
            landings_.on(tile.triangle, 0.5 * (tile.barycentric[j] + tile.barycentric[k]));
        edge.middle = is_new ? landing : shared(edge.middle, landing);
        edge.film_per_surface = std::max(edge.film_per_surface, tile.film_per_surface);
        if (edge.sides < 2) edge.side[edge.sides++] = surface_per_film(tile);
      }
    }
    return edges;
  }

  [[nodiscard]] SurfacePerFilm surface_per_film(const Tile& tile) const {
    const auto& [a, b, c] = tile.node;
    SurfacePerFilm surface;
    surface << nodes_[b].surface_mm - nodes_[a].surface_mm,
        nodes_[c].surface_mm - nodes_[a].surface_mm;
    Eigen::Matrix2d film;
    film << nodes_[b].film_mm - nodes_[a].film_mm, nodes_[c].film_mm - nodes_[a].film_mm;
    return surface * film.inverse();
  }

  Status trace_middles(std::vector<Edge>& edges, const Context& context) const {
    std::vector<Landing> middles;
    middles.reserve(edges.size());
    for (const Edge& edge : edges) middles.push_back(edge.middle);
    HP_ASSIGN_OR_RETURN(const std::vector<Vector2d> film, trace_back(dip_, middles, {}, context));
    for (std::size_t e = 0; e < edges.size(); ++e) edges[e].film_mm = film[e];
    return {};
  }

  /// Decides for each traced edge whether it is linear, should be divided, or crosses a jump.
  void judge(const std::vector<Edge>& edges) {
    traced_ += edges.size();
    const bool is_limited = edges.size() >= kMostEdges || traced_ >= kMostTraced;
    const bool may_divide = !is_limited && level_ < kMostLevels;
    is_limited_ = is_limited_ || is_limited;
    const double tolerance_mm = is_limited ? std::max(tolerance_mm_, kCoarse_mm) : tolerance_mm_;
    for (const Edge& edge : edges) {
      const Node& a = nodes_[edge.a];
      const Node& b = nodes_[edge.b];
      const Node middle = {0.5 * (a.surface_mm + b.surface_mm), edge.film_mm};
      const Vector2d off = middle.film_mm - 0.5 * (a.film_mm + b.film_mm);
      const double off_mm = off.norm();
      EdgeState state = EdgeState::kLinear;
      const double surface_mm = (b.surface_mm - a.surface_mm).norm();
      if (std::min(off_mm, edge.off_on_surface_mm(off)) <=
          tolerance_mm) {  // false if any of the three film points is NaN
        state = EdgeState::kLinear;
      } else if (!is_reached(a) && !is_reached(b) && !is_reached(middle)) {
        state = EdgeState::kLinear;  // nothing lands there at all
      } else if (!may_divide || edge.film_per_surface * surface_mm <= options_.least_edge_mm) {
        state = EdgeState::kBroken;
      } else {
        state = EdgeState::kDivided;
        middle_.set(edge.a, edge.b, static_cast<int>(nodes_.size()));
        nodes_.push_back(middle);
      }
      state_.set(edge.a, edge.b, state);
    }
  }

  void divide() {
    std::vector<Tile> next;
    for (const Tile& tile : active_) {
      std::array<int, 3> middle = {-1, -1, -1};
      bool is_divided = false;
      for (int i = 0; i < 3; ++i) {
        const int a = tile.node[(i + 1) % 3], b = tile.node[(i + 2) % 3];
        if (*state_.find(a, b) != EdgeState::kDivided) continue;
        middle[i] = *middle_.find(a, b);
        is_divided = true;
      }
      if (is_divided) {
        split(tile, middle, next);
      } else {
        finish(tile);
      }
    }
    std::erase_if(next, [&](const Tile& tile) {
      return !is_reached(nodes_[tile.node[0]]) && !is_reached(nodes_[tile.node[1]]) &&
             !is_reached(nodes_[tile.node[2]]);
    });
    active_ = std::move(next);
  }

  /// Splits a tile into two, three or four tiles, depending on the number of divided edges.
  static void split(const Tile& tile, const std::array<int, 3>& middle, std::vector<Tile>& out) {
    const auto bary_middle = [&](int i) -> Vector3d {
      return 0.5 * (tile.barycentric[(i + 1) % 3] + tile.barycentric[(i + 2) % 3]);
    };
    // A corner of the tile, or the midpoint of one of its edges.
    struct Corner {
      int node;
      Vector3d barycentric;
    };
    const auto corner = [&](int i) { return Corner{tile.node[i % 3], tile.barycentric[i % 3]}; };
    const auto mid = [&](int i) { return Corner{middle[i % 3], bary_middle(i % 3)}; };
    const auto add = [&](const Corner& a, const Corner& b, const Corner& c) {
      out.push_back({tile.triangle,
                     tile.film_per_surface,
                     {a.node, b.node, c.node},
                     {a.barycentric, b.barycentric, c.barycentric}});
    };
    const int divided = (middle[0] >= 0) + (middle[1] >= 0) + (middle[2] >= 0);
    if (divided == 3) {
      for (int i = 0; i < 3; ++i) add(corner(i), mid(i + 2), mid(i + 1));
      add(mid(0), mid(1), mid(2));
      return;
    }
    if (divided == 1) {
      const int i = middle[0] >= 0 ? 0 : (middle[1] >= 0 ? 1 : 2);
      add(corner(i), corner(i + 1), mid(i));
      add(corner(i), mid(i), corner(i + 2));
      return;
    }
    // The edge opposite this corner is not divided.
    const int whole = middle[0] < 0 ? 0 : (middle[1] < 0 ? 1 : 2);
    add(corner(whole), mid(whole + 2), mid(whole + 1));
    add(mid(whole + 2), corner(whole + 1), mid(whole + 1));
    add(corner(whole + 1), corner(whole + 2), mid(whole + 1));
  }

  void finish(const Tile& tile) {
    for (int i = 0; i < 3; ++i) {
      if (!is_reached(nodes_[tile.node[i]])) return;
      if (*state_.find(tile.node[(i + 1) % 3], tile.node[(i + 2) % 3]) == EdgeState::kBroken) {
        return;
      }
    }
    MappedTriangle mapped;
    mapped.triangle = tile.triangle;
    // The film touches the surface from outside, so orientation on the film, seen from above, is
    // reversed.
    for (int i = 0; i < 3; ++i) {
      const int from = 2 - i;
      const Node& node = nodes_[tile.node[from]];
      mapped.film_mm[i] = node.film_mm.cwiseQuotient(options_.swelling);
      mapped.barycentric[i] = tile.barycentric[from].cast<float>();
      mapped.contact_time_s[i] =
          static_cast<float>(node.surface_mm.z() / options_.dip_speed_mm_per_s);
    }
    const Vector2d u = mapped.film_mm[1] - mapped.film_mm[0];
    const Vector2d v = mapped.film_mm[2] - mapped.film_mm[0];
    if (u.x() * v.y() - u.y() * v.x() > 0) done_.push_back(mapped);
  }

  const waterline::Body& body_;
  const DipField& dip_;
  const Landings& landings_;
  const MapOptions& options_;
  double tolerance_mm_;  ///< tolerance at the current level of division
  int level_ = 0;
  std::size_t traced_ = 0;  ///< edges, in all levels
  bool is_limited_ = false;
  std::vector<Node> nodes_;
  std::vector<Tile> active_;
  std::vector<MappedTriangle> done_;
  EdgeTable<EdgeState> state_;
  EdgeTable<int> middle_;  ///< midpoints of divided edges
};

}  // namespace

Result<Tiles> make_tiles(const waterline::Body& body, const DipField& dip, const Landings& landings,
                         const std::vector<Vector2d>& film_mm, const MapOptions& options,
                         const Context& context) {
  HP_CHECK(film_mm.size() == body.points_mm.size());
  HP_CHECK(dip.immersion_mm.size() == dip.fields.size());
  Tiler tiler(body, dip, landings, film_mm, options);
  HP_RETURN_IF_ERROR(tiler.run(context));
  return tiler.take();
}

}  // namespace hydroprint::flow
