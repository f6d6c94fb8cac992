#include "sim/sheet/sheet_flow.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "sim/sheet/dip_parts.h"
#include "sim/velocity/sheet.h"

namespace hydroprint::sheet {
namespace {

using velocity::VelocityField;

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
