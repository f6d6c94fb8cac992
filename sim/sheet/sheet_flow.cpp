#include "sim/sheet/sheet_flow.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>
#include <cstdlib>
#include <cstdio>

#include "sim/velocity/sheet.h"

namespace hydroprint::sheet {
namespace {

using Eigen::Vector2d;
using velocity::VelocityField;

/// The velocities at the film's edges, NaN at all other nodes.
std::vector<Vector2d> prescribed(const VelocityField& field) {
  const velocity::FilmMesh& mesh = field.mesh();
  std::vector<Vector2d> fixed(mesh.node_count(),
                              Vector2d::Constant(std::numeric_limits<double>::quiet_NaN()));
  const auto copy = [&](std::size_t node) { fixed[node] = field.nodes()[node]; };
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    if (mesh.edge_kind[e] == velocity::EdgeKind::kInner) continue;
    copy(mesh.vertices_mm.size() + e);
    for (const int v : mesh.edges[e]) copy(v);
  }
  return fixed;
}

/// Length of dip that a waterline stands for.
double span_mm(const flow::DipField& dip, std::size_t k) {
  const double before = k > 0 ? dip.immersion_mm[k - 1] : 0;
  const double after = k + 1 < dip.immersion_mm.size() ? dip.immersion_mm[k + 1] : dip.depth_mm;
  return 0.5 * (after - before);
}

double largest_change(const std::vector<Vector2d>& a, const std::vector<Vector2d>& b) {
  double most = 0;
  for (std::size_t n = 0; n < a.size(); ++n) most = std::max(most, (a[n] - b[n]).norm());
  return most;
}

/// Solves the waterlines [first, last) of the dip, those before being solved.
Status solve_window(SheetFlow& flow, std::size_t first, std::size_t last,
                    const RestThickness& rest_thickness, const SheetOptions& options,
                    const Context& context) {
  const std::size_t count = last - first;
  std::vector<velocity::Sheet> sheets;
  for (std::size_t k = first; k < last; ++k) {
    const VelocityField& field = flow.field.fields[k];
    sheets.emplace_back(field.mesh(), options.drag_per_mm, prescribed(field));
  }
  double move_before_mm = 0;  // none
  for (int sweep = 1; sweep <= options.most_sweeps; ++sweep) {
    std::vector<VelocityField> next(count);
    std::vector<double> moves_mm(count);
    HP_RETURN_IF_ERROR(parallel_for(context, {}, count, [&](std::size_t i) -> Status {
      const std::size_t k = first + i;
      const VelocityField& before = flow.field.fields[k];
      HP_ASSIGN_OR_RETURN(auto nodes,
                          sheets[i].solve(thickness_mm(flow.field, k, rest_thickness)));
      moves_mm[i] = span_mm(flow.field, k) * largest_change(nodes, before.nodes());
      next[i] = before.with(std::move(nodes));
      return {};
    }));
    std::move(next.begin(), next.end(), flow.field.fields.begin() + static_cast<std::ptrdiff_t>(first));
    flow.sweeps = std::max(flow.sweeps, sweep);
    const double move_mm = std::accumulate(moves_mm.begin(), moves_mm.end(), 0.0);
    if (std::getenv("VERB")) std::printf("  window %zu sweep %d move %.5f\n", first, sweep, move_mm);
    // The next sweep would move the film by about as much less again.
    if (sweep > 1 && move_mm * std::min(1.0, move_mm / move_before_mm) < options.tolerance_mm) break;
    move_before_mm = move_mm;
  }
  return {};
}

}  // namespace

Result<SheetFlow> sheet_flow(flow::DipField first, const RestThickness& rest_thickness,
                             const SheetOptions& options, const Context& context) {
  SheetFlow flow{std::move(first), 0};
  const std::size_t count = flow.field.fields.size();
  const std::size_t kWindow = std::getenv("WIN") ? std::atoi(std::getenv("WIN")) : 16;
  for (std::size_t k = 0; k < count; k += kWindow) {
    context.progress("sheet", static_cast<double>(k) / static_cast<double>(count));
    HP_RETURN_IF_ERROR(solve_window(flow, k, std::min(k + kWindow, count), rest_thickness, options,
                                    context));
  }
  return flow;
}

}  // namespace hydroprint::sheet
