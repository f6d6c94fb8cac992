#include "sim/plan/regions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sim/plan/borders.h"
#include "sim/plan/facets.h"
#include "sim/plan/pieces.h"

namespace hydroprint::plan {
namespace {

Status check_stretch(const mesh::Surface& surface, const Stretch& stretch) {
  if (stretch.empty() || stretch.size() > kMaxDips)
    return fail(Code::kInvalidArgument,
                fmt::format("{} dips; use 1 to {} dips.", stretch.size(), kMaxDips));
  for (std::size_t k = 0; k < stretch.size(); ++k) {
    if (stretch[k].size() != surface.points.size())
      return fail(Code::kInvalidArgument,
                  fmt::format("dip {}: {} stretch values for {} points; give one for each point.",
                              k + 1, stretch[k].size(), surface.points.size()));
    const auto bad = std::find_if(stretch[k].begin(), stretch[k].end(),
                                  [](double value) { return !(value >= 0); });
    if (bad != stretch[k].end())
      return fail(Code::kInvalidArgument,
                  fmt::format("dip {}, point {}: stretch {} is not valid; use values of at least "
                              "0, or infinity where the film does not arrive.",
                              k + 1, bad - stretch[k].begin(), *bad));
  }
  return {};
}

void add_seam(const Eigen::Vector3d& from, const Eigen::Vector3d& to, int dip, int other,
              Regions& regions) {
  regions.seam.push_back({from, to, std::min(dip, other), std::max(dip, other)});
  regions.seam_mm += (to - from).norm();
}

/// Along an edge of more than two triangles, the seam is counted once.
void add_edge_seam(const mesh::Surface& surface, const Facets& facets, const Borders& borders,
                   const EdgeBorder& border, Regions& regions) {
  int first_dip = 0;
  for (const int fragment : borders.fragments(border, facets)) {
    const int dip = regions.fragments.all[static_cast<std::size_t>(fragment)].dip;
    if (dip == 0 || dip == first_dip) continue;
    if (first_dip == 0) {
      first_dip = dip;
      continue;
    }
    const int side = facets.edges().sides(border.edge).front();
    add_seam(place_of(surface, side / 3, on_side(side, border.from)),
             place_of(surface, side / 3, on_side(side, border.to)), first_dip, dip, regions);
    return;
  }
}

void measure_seam(const mesh::Surface& surface, const Facets& facets, const Borders& borders,
                  Regions& regions) {
  const auto& fragments = regions.fragments.all;
  for (const auto& border : borders.inner) {
    const Fragment& a = fragments[static_cast<std::size_t>(border.fragment)];
    const Fragment& b = fragments[static_cast<std::size_t>(border.other)];
    if (a.dip == b.dip) continue;
    add_seam(place_of(surface, a.triangle, border.ends[0]),
             place_of(surface, a.triangle, border.ends[1]), a.dip, b.dip, regions);
  }
  for (const auto& border : borders.across)
    add_edge_seam(surface, facets, borders, border, regions);
}

/// Returns the share of a triangle that does not lie inside another part of the model.
double outer_share(const mesh::Surface& surface, int triangle) {
  int outer = 0;
  for (int k = 0; k < 3; ++k)
    outer += surface.is_inner(static_cast<std::size_t>(triangle), k) ? 0 : 1;
  return outer / 3.0;
}

void measure_sizes(const mesh::Surface& surface, const Facets& facets,
                   const std::vector<int>& piece_of, Regions& regions) {
  double unreached_mm2 = 0;
  double total_mm2 = 0;
  int pieces = 0;
  for (std::size_t f = 0; f < regions.fragments.all.size(); ++f) {
    const Fragment& fragment = regions.fragments.all[f];
    const double area_mm2 = regions.fragments.share(f) * facets.area_mm2(fragment.triangle);
    const bool is_new_piece = piece_of[f] == pieces;
    if (is_new_piece) ++pieces;
    if (fragment.dip == 0) {
      const double outer_mm2 = area_mm2 * outer_share(surface, fragment.triangle);
      unreached_mm2 += outer_mm2;
      total_mm2 += outer_mm2;
      continue;
    }
    total_mm2 += area_mm2;
    RegionSize& size = regions.sizes[static_cast<std::size_t>(fragment.dip - 1)];
    size.area_mm2 += area_mm2;
    size.pieces += is_new_piece ? 1 : 0;
  }
  regions.unreached_share = total_mm2 > 0 ? unreached_mm2 / total_mm2 : 0;
}

}  // namespace

Result<Regions> make_regions(const mesh::Surface& surface, const Stretch& stretch,
                             const RegionOptions& options, const Context& context) {
  HP_RETURN_IF_ERROR(check_stretch(surface, stretch));
  if (!(options.min_piece_mm2 >= 0))
    return fail(Code::kInvalidArgument,
                fmt::format("smallest piece of {} mm2; use at least 0.", options.min_piece_mm2));
  Regions regions;
  regions.dips = static_cast<int>(stretch.size());
  regions.sizes.resize(stretch.size());
  HP_ASSIGN_OR_RETURN(regions.fragments, divide_triangles(surface, stretch, context));
  const Facets facets(surface);
  const Borders borders = find_borders(facets, regions.fragments);
  const auto piece_of =
      join_small_pieces(facets, borders, options.min_piece_mm2, regions.fragments);
  HP_RETURN_IF_ERROR(check_cancelled(context));
  measure_seam(surface, facets, borders, regions);
  measure_sizes(surface, facets, piece_of, regions);
  return regions;
}

std::vector<int> dips_at_points(const mesh::Surface& surface, const Fragments& fragments) {
  std::vector<int> out;
  for (const int corner : reached_corners(surface, fragments)) {
    if (corner < 0) {
      out.push_back(0);
      continue;
    }
    const Eigen::Vector3d at = Eigen::Vector3d::Unit(corner % 3);
    out.push_back(fragments.all[fragments.find(corner / 3, at)].dip);
  }
  return out;
}

}  // namespace hydroprint::plan
