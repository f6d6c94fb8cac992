#include "sim/image/figures/object_views.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace hydroprint::image {
namespace {

/// Arrangement of the views.
struct Layout {
  int columns = 2;
  int width_px = 0, height_px = 0;
  double px_per_mm = 1;
};

/// Chooses two by two views or four in a row: the row, unless it shows the object much smaller.
Layout lay_out(const mesh::Surface& surface, const Pose& X_FO, const std::vector<View>& views) {
  Layout best;
  double best_score = 0;
  Eigen::Vector2d half = Eigen::Vector2d::Constant(1e-6);
  for (const View& view : views) half = half.cwiseMax(half_extent_mm(surface, X_FO, view));
  for (const int columns : {2, 4}) {
    Layout layout;
    layout.columns = columns;
    layout.width_px = (kSheetWidth_px - (columns + 1) * kMargin_px) / columns;
    const double limit = columns == 4 ? 765 : 510;
    layout.px_per_mm =
        std::min((layout.width_px - 8) / (2 * half.x()), (limit - 8) / (2 * half.y()));
    layout.height_px = static_cast<int>(2 * half.y() * layout.px_per_mm) + 9;
    const double score = layout.px_per_mm * (columns == 2 ? 0.8 : 1.0);
    if (score > best_score) {
      best_score = score;
      best = layout;
    }
  }
  return best;
}

}  // namespace

Result<ObjectViews> find_views(const mesh::Surface& surface, const Pose& X_FO,
                               std::span<const flow::MappedTriangle> tiles,
                               const Context& context) {
  const std::vector<View> views = standard_views();
  const Layout layout = lay_out(surface, X_FO, views);
  std::vector<std::optional<SeenObject>> seen(views.size());
  HP_RETURN_IF_ERROR(parallel_for(context, {}, views.size(), [&](std::size_t v) {
    seen[v].emplace(surface, X_FO, tiles, views[v], layout.width_px, layout.height_px,
                    layout.px_per_mm);
    return Status{};
  }));
  ObjectViews out{surface, layout.columns, layout.width_px, layout.height_px, {}, {}};
  for (std::size_t v = 0; v < views.size(); ++v) {
    out.names.push_back(views[v].name);
    out.seen.push_back(*std::move(seen[v]));
  }
  return out;
}

}  // namespace hydroprint::image
