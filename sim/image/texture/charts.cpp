#include "sim/image/texture/charts.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "sim/base/check.h"
#include "sim/image/texture/raster.h"

namespace hydroprint::image {
namespace {

constexpr int kRings = 16;
constexpr double kMaxCover = 64;
/// If a chart shares more than this fraction of its texels with other charts, they overlap on
/// purpose; a smaller fraction is due to rounding along a common border.
constexpr double kSharedPart = 0.02;

class UnionFind {
 public:
  explicit UnionFind(std::size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  int find(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(int a, int b) {
    const auto [low, high] = std::minmax({find(a), find(b)});
    parent_[high] = low;
  }

 private:
  std::vector<int> parent_;
};

std::uint64_t mix(std::uint64_t hash, double value) {
  // Adding zero maps -0 and 0 to the same value.
  std::uint64_t x = hash ^ (std::bit_cast<std::uint64_t>(value + 0.0) + 0x9E3779B97F4A7C15U +
                            (hash << 6) + (hash >> 2));
  x = (x ^ x >> 30) * 0xBF58476D1CE4E5B9U;
  x = (x ^ x >> 27) * 0x94D049BB133111EBU;
  return x ^ x >> 31;
}

std::uint64_t corner_hash(const UvTriangle& triangle, int corner) {
  std::uint64_t hash = 0;
  for (int i = 0; i < 3; ++i) hash = mix(hash, triangle.position[corner][i]);
  for (int i = 0; i < 2; ++i) hash = mix(hash, triangle.uv[corner][i]);
  return hash;
}

/// Returns for each triangle the number of its connected piece: 0, 1, ... in order of their first
/// triangles.
std::vector<int> connected_pieces(const std::vector<UvTriangle>& triangles, int& count) {
  std::vector<std::pair<std::uint64_t, int>> edges;
  edges.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    std::array<std::uint64_t, 3> corners;
    for (int i = 0; i < 3; ++i) corners[i] = corner_hash(triangles[t], i);
    for (int i = 0; i < 3; ++i) {
      // The sum is symmetric in the edge's two ends.
      edges.emplace_back(corners[i] + corners[(i + 1) % 3], static_cast<int>(t));
    }
  }
  std::sort(edges.begin(), edges.end());
  UnionFind pieces(triangles.size());
  for (std::size_t i = 1; i < edges.size(); ++i) {
    if (edges[i].first == edges[i - 1].first) pieces.unite(edges[i].second, edges[i - 1].second);
  }
  std::vector<int> number(triangles.size(), -1), piece_of(triangles.size());
  count = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    int& piece = number[pieces.find(static_cast<int>(t))];
    if (piece < 0) piece = count++;
    piece_of[t] = piece;
  }
  return piece_of;
}

int fold_index(std::int64_t i, int size, mesh::Wrap wrap) {
  const std::int64_t n = size;
  if (i >= 0 && i < n) return static_cast<int>(i);
  if (wrap == mesh::Wrap::kClamp) return static_cast<int>(std::clamp<std::int64_t>(i, 0, n - 1));
  const std::int64_t period = wrap == mesh::Wrap::kMirror ? 2 * n : n;
  const std::int64_t folded = ((i % period) + period) % period;
  return static_cast<int>(folded < n ? folded : period - 1 - folded);
}

/// Finds the texels under triangles, which may lie in any unit tile.
class Marker {
 public:
  Marker(Texels& texels, mesh::Wrap u, mesh::Wrap v) : texels_(texels), u_(u), v_(v) {}

  [[nodiscard]] Eigen::Vector2d position(const Eigen::Vector2d& uv) const {
    return {uv.x() * texels_.width, (1 - uv.y()) * texels_.height};
  }
  [[nodiscard]] Texel& at(std::int64_t x, std::int64_t y) const {
    return texels_
        .texels[static_cast<std::size_t>(fold_index(y, texels_.height, v_)) * texels_.width +
                fold_index(x, texels_.width, u_)];
  }
  /// Calls visit(texel) for each texel whose centre lies in the triangle.
  template <class Visit>
  void for_each(const UvTriangle& triangle, Visit&& visit) const {
    Corners corners;
    for (int i = 0; i < 3; ++i) corners[i] = position(triangle.uv[i]);
    const Eigen::Vector2d low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
    if (!low.allFinite() || low.cwiseAbs().maxCoeff() > 1e9) return;
    // Relative to the triangle's lower corner. From there, a window of two textures in each
    // direction reaches every texel, even under larger triangles.
    const std::int64_t x0 = static_cast<std::int64_t>(std::floor(low.x()));
    const std::int64_t y0 = static_cast<std::int64_t>(std::floor(low.y()));
    for (auto& corner : corners)
      corner -= Eigen::Vector2d(static_cast<double>(x0), static_cast<double>(y0));
    const Window window{0, 0, 2 * texels_.width, 2 * texels_.height};
    for_each_span(corners, window, [&](int y, int begin, int end) {
      for (int x = begin; x < end; ++x) visit(at(x + x0, y + y0));
    });
  }

 private:
  Texels& texels_;
  mesh::Wrap u_, v_;
};

double cover(const std::vector<UvTriangle>& triangles) {
  double area = 0;
  for (const auto& triangle : triangles) {
    const Eigen::Vector2d a = triangle.uv[1] - triangle.uv[0], b = triangle.uv[2] - triangle.uv[0];
    const double part = 0.5 * std::abs(a.x() * b.y() - a.y() * b.x());
    if (std::isfinite(part)) area += std::min(part, 4.0);
  }
  return area;
}

std::uint16_t id_of(int piece) { return static_cast<std::uint16_t>(1 + piece % 65535); }

/// Marks the texels of every piece and merges pieces that overlap.
/// @return for each id (1 ... 65535), the id of the merged chart
std::vector<std::uint16_t> mark(const std::vector<UvTriangle>& triangles,
                                const std::vector<int>& piece_of, int pieces,
                                const Marker& marker) {
  HP_CHECK(piece_of.size() == triangles.size());
  struct Count {
    std::int64_t all = 0, shared = 0;
  };
  std::vector<Count> counts(pieces);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    Count& count = counts[piece_of[t]];
    const std::uint16_t id = id_of(piece_of[t]);
    marker.for_each(triangles[t], [&](Texel& texel) {
      if (texel.chart == 0) texel.chart = id;
      ++count.all;
      if (texel.chart != id) ++count.shared;
    });
  }
  UnionFind same(65536);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Count& count = counts[piece_of[t]];
    const std::uint16_t id = id_of(piece_of[t]);
    if (static_cast<double>(count.shared) > kSharedPart * static_cast<double>(count.all)) {
      marker.for_each(triangles[t], [&](const Texel& texel) { same.unite(texel.chart, id); });
    }
    if (count.all > 0) continue;
    // The piece is too slim to contain a texel's centre, so it gets the unmarked texels at its
    // triangles' corners.
    const auto& uv = triangles[t].uv;
    for (const Eigen::Vector2d& point : {uv[0], uv[1], uv[2]}) {
      const Eigen::Vector2d p = marker.position(point);
      if (!p.allFinite() || p.cwiseAbs().maxCoeff() > 1e9) continue;
      Texel& texel = marker.at(static_cast<std::int64_t>(std::floor(p.x())),
                               static_cast<std::int64_t>(std::floor(p.y())));
      if (texel.chart == 0) texel.chart = id;
    }
  }
  std::vector<std::uint16_t> became(65536);
  for (int id = 0; id < 65536; ++id) became[id] = static_cast<std::uint16_t>(same.find(id));
  return became;
}

/// Calls visit(index) for the up to eight texels around one, nearest first.
template <class Visit>
void for_each_neighbour(const Texels& image, std::size_t at, Visit&& visit) {
  static constexpr std::array<std::array<int, 2>, 8> kAround = {
      {{0, -1}, {-1, 0}, {1, 0}, {0, 1}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}}};
  const auto width = static_cast<std::size_t>(image.width);
  const int x = static_cast<int>(at % width), y = static_cast<int>(at / width);
  for (const auto& [dx, dy] : kAround) {
    const int nx = x + dx, ny = y + dy;
    if (nx < 0 || ny < 0 || nx >= image.width || ny >= image.height) continue;
    visit(static_cast<std::size_t>(ny) * width + static_cast<std::size_t>(nx));
  }
}

/// Extends all charts into the background, simultaneously, by one ring of texels at a time.
void dilate(Texels& image) {
  std::vector<std::size_t> frontier;
  for (std::size_t i = 0; i < image.texels.size(); ++i) {
    if (image.texels[i].chart == 0) continue;
    bool is_border = false;
    for_each_neighbour(image, i,
                       [&](std::size_t k) { is_border = is_border || image.texels[k].chart == 0; });
    if (is_border) frontier.push_back(i);
  }
  for (int ring = 0; ring < kRings && !frontier.empty(); ++ring) {
    std::vector<std::size_t> next;
    for (const std::size_t i : frontier) {
      for_each_neighbour(image, i, [&](std::size_t k) {
        if (image.texels[k].chart != 0) return;
        image.texels[k] = image.texels[i];
        next.push_back(k);
      });
    }
    frontier = std::move(next);
  }
}

/// Returns whether [low, high] lies in one unit interval that starts at an integer, up to rounding.
bool is_in_one_tile(double low, double high, double& tile) {
  constexpr double kRounding = 1e-4;
  tile = std::floor(0.5 * (low + high));
  return low >= tile - kRounding && high <= tile + 1 + kRounding;
}

std::vector<Chart> piece_charts(const std::vector<UvTriangle>& triangles,
                                const std::vector<int>& piece_of, int pieces) {
  HP_CHECK(piece_of.size() == triangles.size());
  const Eigen::Vector2d huge = Eigen::Vector2d::Constant(HUGE_VAL);
  std::vector<Eigen::Vector2d> low(pieces, huge), high(pieces, -huge);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (const auto& uv : triangles[t].uv) {
      low[piece_of[t]] = low[piece_of[t]].cwiseMin(uv);
      high[piece_of[t]] = high[piece_of[t]].cwiseMax(uv);
    }
  }
  std::vector<Chart> charts(pieces);
  for (int piece = 0; piece < pieces; ++piece) {
    for (int axis = 0; axis < 2; ++axis) {
      charts[piece].in_one_tile[axis] =
          is_in_one_tile(low[piece][axis], high[piece][axis], charts[piece].tile[axis]);
    }
  }
  return charts;
}

}  // namespace

std::vector<Chart> make_charts(const std::vector<UvTriangle>& triangles, mesh::Wrap wrap_u,
                               mesh::Wrap wrap_v, Texels& texels) {
  int pieces = 0;
  const std::vector<int> piece_of = connected_pieces(triangles, pieces);
  std::vector<Chart> piece_chart = piece_charts(triangles, piece_of, pieces);
  if (cover(triangles) <= kMaxCover) {
    const Marker marker(texels, wrap_u, wrap_v);
    const std::vector<std::uint16_t> became = mark(triangles, piece_of, pieces, marker);
    for (Texel& texel : texels.texels) texel.chart = became[texel.chart];
    dilate(texels);
    for (int piece = 0; piece < pieces; ++piece) piece_chart[piece].id = became[id_of(piece)];
  }
  std::vector<Chart> charts(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) charts[t] = piece_chart[piece_of[t]];
  return charts;
}

}  // namespace hydroprint::image
