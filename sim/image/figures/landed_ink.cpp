#include "sim/image/figures/landed_ink.h"

#include <limits>

#include "sim/base/check.h"
#include "sim/image/figures/contact_sheet.h"
#include "sim/image/io/colour.h"

namespace hydroprint::image {
namespace {

const Eigen::Vector3f kNoFilm = Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());

Eigen::Vector3f colour_of(const Eigen::Vector3f& ink) {
  if (ink.hasNaN()) return kBareObject;
  return linear_from_srgb(Eigen::Vector3f(Eigen::Vector3f::Ones() - ink.cwiseMin(1.0F)));
}

}  // namespace

Result<LandedInk> landed_ink(const ObjectViews& views, const FilmTexture& film,
                             const Context& context) {
  LandedInk out(views.seen.size());
  HP_RETURN_IF_ERROR(parallel_for(context, {}, views.seen.size(), [&](std::size_t v) {
    const SeenObject& seen = views.seen[v];
    out[v].assign(seen.samples().size(), kNoFilm);
    for (std::size_t i = 0; i < seen.seen_tiles(); ++i) {
      const auto [tile, samples] = seen.seen_tile(i);
      const auto corners = seen.tile_corners(tile);
      const Brush brush = film.brush(
          {corners[0].head<2>(), corners[1].head<2>(), corners[2].head<2>()}, tile.film_mm);
      for (const int s : samples) {
        const Eigen::Vector3f light = brush.at(s % seen.width() + 0.5, s / seen.width() + 0.5);
        out[v][static_cast<std::size_t>(s)] = Eigen::Vector3f::Ones() - srgb_from_linear(light);
      }
    }
    return Status{};
  }));
  return out;
}

void add_ink(const LandedInk& more, LandedInk& ink) {
  if (ink.empty()) {
    ink = more;
    return;
  }
  for (std::size_t v = 0; v < ink.size(); ++v) {
    HP_CHECK(ink[v].size() == more[v].size());
    for (std::size_t s = 0; s < ink[v].size(); ++s) {
      if (more[v][s].hasNaN()) continue;
      ink[v][s] = ink[v][s].hasNaN() ? more[v][s] : ink[v][s] + more[v][s];
    }
  }
}

Result<RgbImage> ink_picture(const ObjectViews& views, const LandedInk& ink,
                             const Context& context) {
  HP_CHECK(ink.size() == views.seen.size());
  return draw_sheet(views, 0, context, [&](ViewDrawing& drawing, std::size_t v) {
    const int width = views.seen[v].width();
    drawing.draw_bare(
        [&](int x, int y) { return colour_of(ink[v][static_cast<std::size_t>(y) * width + x]); });
  });
}

}  // namespace hydroprint::image
