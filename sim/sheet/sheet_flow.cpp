#include "sim/sheet/sheet_flow.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "sim/base/check.h"
#include "sim/sheet/dip_parts.h"
#include "sim/sheet/sheet.h"

namespace hydroprint::sheet {
namespace {

using velocity::VelocityField;

/// Number of waterlines solved together. With a small number, each window starts from converged
/// waterlines; a large one keeps the cores busy. It must not depend on the number of cores, because
/// the results depend on it.
constexpr std::size_t kWindow = 8;

/// If a sweep moves the film by at least this fraction of the previous sweep's displacement, the
/// film does not converge. Film that tears or folds has no definite thickness.
constexpr double kSettling = 0.5;

/// State of the sweeps over a window of waterlines. A waterline depends only on those before it, so
/// they converge in order, and converged ones are not solved again.
class Progress {
 public:
  explicit Progress(std::size_t count) : moved_mm(count), before_mm_(count) {}

  /// Displacement of the film at each waterline in this sweep.
  std::vector<double> moved_mm;

  /// Returns the first waterline that has not converged.
  [[nodiscard]] std::size_t first() const { return first_; }
  /// Returns the total displacement in this sweep at waterlines that had not converged.
  [[nodiscard]] double sum_mm() const { return sum(moved_mm, moved_mm.size()); }

  enum class Next { kSweep, kSettled, kUnsettled };
  /// Decides how to continue. Must be called after each sweep except the first. Assumes that the
  /// next sweep reduces the displacement by the same factor as this one. The tolerance is divided
  /// evenly among the waterlines.
  Next judge(double tolerance_mm) {
    const std::size_t count = moved_mm.size();
    const double before_mm = sum(before_mm_, count);
    const double shrinkage = before_mm > 0 ? sum_mm() / before_mm : 0;
    if (!(shrinkage < kSettling)) return Next::kUnsettled;
    if (sum_mm() * shrinkage < tolerance_mm) return Next::kSettled;
    const double each_mm = tolerance_mm / static_cast<double>(count);
    std::size_t settled = first_;
    for (std::size_t i = first_; i < count; ++i) {
      const double now = sum(moved_mm, i + 1), then = sum(before_mm_, i + 1);
      if (!(now * now < each_mm * static_cast<double>(i + 1 - first_) * then)) break;
      settled = i + 1;
    }
    first_ = settled;
    return Next::kSweep;
  }
  void next_sweep() { before_mm_ = moved_mm; }

 private:
  [[nodiscard]] double sum(const std::vector<double>& of, std::size_t end) const {
    const auto at = [&](std::size_t i) { return of.begin() + static_cast<std::ptrdiff_t>(i); };
    return std::accumulate(at(first_), at(end), 0.0);
  }

  std::vector<double> before_mm_;
  std::size_t first_ = 0;
};

/// Solves the waterlines [first, last) of the dip. All waterlines before them must be solved.
Status solve_window(SheetFlow& flow, std::size_t first, std::size_t last,
                    const flow::RestMap* known, const RestThickness& rest_thickness,
                    const SheetOptions& options, const Context& context) {
  HP_CHECK(first < last);
  HP_CHECK(last <= flow.field.fields.size());
  const std::size_t count = last - first;
  std::vector<std::optional<velocity::Sheet>> sheets(count);
  Progress progress(count);
  for (int sweep = 1;; ++sweep) {
    const std::size_t begin = progress.first();
    std::vector<VelocityField> next(count);
    std::vector<std::vector<char>> torn(count);
    HP_RETURN_IF_ERROR(parallel_for(context, {}, count - begin, [&](std::size_t task) -> Status {
      const std::size_t i = begin + task, k = first + i;
      const VelocityField& before = flow.field.fields[k];
      if (!sheets[i]) sheets[i].emplace(before.mesh(), options.drag_per_mm, prescribed(before));
      FloatingFilm film = floating_film(flow.field, k, rest_thickness, options.tear_stretch, known);
      HP_ASSIGN_OR_RETURN(auto nodes, sheets[i]->solve(film.thickness_mm));
      torn[i] = std::move(film.is_torn);
      progress.moved_mm[i] = span_mm(flow.field, k) * rms_change(nodes, before.nodes());
      next[i] = before.with(std::move(nodes));
      return {};
    }));
    for (std::size_t i = begin; i < count; ++i) {
      flow.field.fields[first + i] = std::move(next[i]);
      flow.field.is_torn[first + i] = std::move(torn[i]);
    }
    flow.sweeps = std::max(flow.sweeps, sweep);
    const double moved_mm = progress.sum_mm();
    if (sweep == 1) {
      if (moved_mm < options.tolerance_mm) return {};  // later sweeps move the film even less
    } else {
      const auto verdict = progress.judge(options.tolerance_mm);
      if (verdict == Progress::Next::kSettled) return {};
      if (verdict == Progress::Next::kUnsettled || sweep == options.most_sweeps) {
        flow.unsettled_mm += moved_mm;
        return {};
      }
    }
    progress.next_sweep();
  }
}

}  // namespace

Result<SheetFlow> sheet_flow(flow::DipField first, const RestThickness& rest_thickness,
                             const SheetOptions& options, const Context& context) {
  HP_CHECK(first.immersion_mm.size() == first.fields.size());
  SheetFlow flow{std::move(first), 0};
  const std::size_t count = flow.field.fields.size();
  flow.field.is_torn.resize(count);
  // Film is traced back only to the previous window, not to the start of the dip.
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
