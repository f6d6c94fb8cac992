#include "sim/plan/pieces.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

#include "sim/mesh/groups.h"

namespace hydroprint::plan {
namespace {

struct Piece {
  int dip = 0;
  double area_mm2 = 0;
  std::uint16_t reach = 0;                  ///< the dips that reach all of its triangles
  std::map<std::size_t, double> border_mm;  ///< per adjacent piece
};

/// Pieces are named by their first fragment.
class PieceGraph {
 public:
  PieceGraph(const Facets& facets, const Borders& borders, double min_area_mm2,
             Fragments& fragments)
      : groups_(fragments.all.size()),
        pieces_(fragments.all.size()),
        min_area_mm2_(min_area_mm2),
        fragments_(fragments) {
    for (std::size_t f = 0; f < pieces_.size(); ++f) {
      const Fragment& fragment = fragments.all[f];
      pieces_[f].dip = fragment.dip;
      pieces_[f].area_mm2 = fragments.share(f) * facets.area_mm2(fragment.triangle);
      pieces_[f].reach = fragments.reach[static_cast<std::size_t>(fragment.triangle)];
    }
    for_each_border(facets, borders, [&](std::size_t a, std::size_t b, double) {
      if (fragments.all[a].dip == fragments.all[b].dip) groups_.join(a, b);
    });
    gather_pieces();
    for_each_border(facets, borders, [&](std::size_t a, std::size_t b, double length_mm) {
      a = groups_.find(a);
      b = groups_.find(b);
      if (a == b) return;
      pieces_[a].border_mm[b] += length_mm;
      pieces_[b].border_mm[a] += length_mm;
    });
  }

  void join_small() {
    for (std::size_t f = 0; f < pieces_.size(); ++f) {
      if (groups_.find(f) == f) consider(f);
    }
    while (!small_.empty()) {
      const std::size_t piece = small_.begin()->second;
      small_.erase(small_.begin());
      if (const std::size_t other = best_neighbour(piece); other != piece) join(piece, other);
    }
    for (std::size_t f = 0; f < pieces_.size(); ++f)
      fragments_.all[f].dip = pieces_[groups_.find(f)].dip;
  }

  std::vector<int> numbers() {
    std::vector<int> numbers(pieces_.size());
    int count = 0;
    for (std::size_t f = 0; f < pieces_.size(); ++f) {
      const std::size_t piece = groups_.find(f);  // its smallest fragment
      numbers[f] = piece == f ? count++ : numbers[piece];
    }
    return numbers;
  }

 private:
  template <class Visit>
  static void for_each_border(const Facets& facets, const Borders& borders, const Visit& visit) {
    for (const auto& border : borders.inner)
      visit(static_cast<std::size_t>(border.fragment), static_cast<std::size_t>(border.other),
            border.length_mm);
    for (const auto& border : borders.across) {
      const auto sides = borders.fragments(border, facets);
      for (std::size_t i = 0; i < sides.size(); ++i)
        for (std::size_t j = i + 1; j < sides.size(); ++j)
          visit(static_cast<std::size_t>(sides[i]), static_cast<std::size_t>(sides[j]),
                border.length_mm);
    }
  }

  void gather_pieces() {
    for (std::size_t f = 0; f < pieces_.size(); ++f) {
      const std::size_t piece = groups_.find(f);
      if (piece == f) continue;
      pieces_[piece].area_mm2 += pieces_[f].area_mm2;
      pieces_[piece].reach &= pieces_[f].reach;
    }
  }

  void consider(std::size_t piece) {
    const Piece& p = pieces_[piece];
    if (p.area_mm2 < min_area_mm2_ && p.reach != 0) small_.emplace(p.area_mm2, piece);
  }

  /// Returns the piece that this one joins; itself if none may take it over.
  [[nodiscard]] std::size_t best_neighbour(std::size_t piece) const {
    std::size_t best = piece;
    double longest_mm = 0;
    for (const auto& [other, length_mm] : pieces_[piece].border_mm) {
      const int dip = pieces_[other].dip;
      if (dip == 0 || (pieces_[piece].reach >> (dip - 1) & 1) == 0) continue;
      if (length_mm <= longest_mm) continue;
      longest_mm = length_mm;
      best = other;
    }
    return best;
  }

  void join(std::size_t piece, std::size_t other) {
    const int dip = pieces_[other].dip;
    pieces_[piece].dip = dip;
    std::vector<std::size_t> same;
    for (const auto& [adjacent, length_mm] : pieces_[piece].border_mm) {
      if (pieces_[adjacent].dip == dip) same.push_back(adjacent);
    }
    for (const std::size_t adjacent : same) piece = unite(piece, adjacent);
    consider(piece);
    // A neighbour that nobody could take over may now have one that can.
    for (const auto& [adjacent, length_mm] : pieces_[piece].border_mm) consider(adjacent);
  }

  /// Makes two adjacent pieces one and returns its name.
  std::size_t unite(std::size_t a, std::size_t b) {
    if (b < a) std::swap(a, b);
    small_.erase({pieces_[a].area_mm2, a});
    small_.erase({pieces_[b].area_mm2, b});
    groups_.join(a, b);
    Piece& whole = pieces_[a];
    const Piece part = std::move(pieces_[b]);
    whole.area_mm2 += part.area_mm2;
    whole.reach &= part.reach;
    whole.border_mm.erase(b);
    for (const auto& [other, length_mm] : part.border_mm) {
      if (other == a) continue;
      pieces_[other].border_mm.erase(b);
      pieces_[other].border_mm[a] += length_mm;
      whole.border_mm[other] += length_mm;
    }
    return a;
  }

  mesh::Groups groups_;
  std::vector<Piece> pieces_;  ///< per fragment; meaningful for the first fragment of a piece
  std::set<std::pair<double, std::size_t>> small_;  ///< area and name of pieces to join
  double min_area_mm2_;
  Fragments& fragments_;
};

}  // namespace

std::vector<int> join_small_pieces(const Facets& facets, const Borders& borders,
                                   double min_area_mm2, Fragments& fragments) {
  PieceGraph graph(facets, borders, min_area_mm2, fragments);
  graph.join_small();
  return graph.numbers();
}

}  // namespace hydroprint::plan
