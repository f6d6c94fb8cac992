#include "sim/sheet/sheet_flow.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

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

double rms_change(const std::vector<Vector2d>& a, const std::vector<Vector2d>& b) {
  double sum = 0;
  for (std::size_t n = 0; n < a.size(); ++n) sum += (a[n] - b[n]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(a.size(), 1)));
}

/// So many waterlines are solved together: few, so that each window starts from what is known for
/// certain; enough to keep the cores busy. Not a matter of how many cores there are, or the results
/// would be.
constexpr std::size_t kWindow = 8;

/// Sweeps that shrink the change less than this do not settle it: film that tears or is folded has
/// no thickness to find.
constexpr double kSettling = 0.5;

/// Solves the waterlines [first, last) of the dip, those before being solved.
Status solve_window(SheetFlow& flow, std::size_t first, std::size_t last,
                    const flow::RestMap* known, const RestThickness& rest_thickness,
                    const SheetOptions& options, const Context& context) {
  const std::size_t count = last - first;
  std::vector<std::optional<velocity::Sheet>> sheets(count);
  double move_before_mm = 0;
  for (int sweep = 1;; ++sweep) {
    std::vector<VelocityField> next(count);
    std::vector<double> moves_mm(count);
    HP_RETURN_IF_ERROR(parallel_for(context, {}, count, [&](std::size_t i) -> Status {
      const std::size_t k = first + i;
      const VelocityField& before = flow.field.fields[k];
      if (!sheets[i]) sheets[i].emplace(before.mesh(), options.drag_per_mm, prescribed(before));
      HP_ASSIGN_OR_RETURN(auto nodes,
                          sheets[i]->solve(thickness_mm(flow.field, k, rest_thickness, known)));
      moves_mm[i] = span_mm(flow.field, k) * rms_change(nodes, before.nodes());
      next[i] = before.with(std::move(nodes));
      return {};
    }));
    std::move(next.begin(), next.end(),
              flow.field.fields.begin() + static_cast<std::ptrdiff_t>(first));
    flow.sweeps = std::max(flow.sweeps, sweep);
    const double move_mm = std::accumulate(moves_mm.begin(), moves_mm.end(), 0.0);
    if (sweep > 1) {
      const double shrinkage = move_before_mm > 0 ? move_mm / move_before_mm : 0;
      const bool settles = shrinkage < kSettling;
      // The next sweep would move the film by about as much less again.
      if (settles && move_mm * shrinkage < options.tolerance_mm) break;
      if (!settles || sweep == options.most_sweeps) {
        flow.unsettled_mm += move_mm;
        break;
      }
    }
    move_before_mm = move_mm;
  }
  return {};
}

}  // namespace

Result<SheetFlow> sheet_flow(flow::DipField first, const RestThickness& rest_thickness,
                             const SheetOptions& options, const Context& context) {
  SheetFlow flow{std::move(first), 0};
  const std::size_t count = flow.field.fields.size();
  // Long dips are not followed back to their beginning each time, but to the last window.
  std::optional<flow::RestMap> known;
  for (std::size_t k = 0; k < count; k += kWindow) {
    context.progress("sheet", static_cast<double>(k) / static_cast<double>(count));
    const std::size_t end = std::min(k + kWindow, count);
    const flow::RestMap* before = known ? &*known : nullptr;
    HP_RETURN_IF_ERROR(solve_window(flow, k, end, before, rest_thickness, options, context));
    if (end == count) break;
    auto rest_mm = flow::trace_back(flow.field, end - 1, before);
    known = flow::RestMap{end - 1, flow.field.fields[end - 1].with(std::move(rest_mm))};
  }
  return flow;
}

}  // namespace hydroprint::sheet
