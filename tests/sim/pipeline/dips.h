#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "sim/pipeline/dip.h"
#include "sim/pipeline/pipeline.h"
#include "tests/support/two_threads.h"

namespace hydroprint::pipeline::testing {

using hydroprint::testing::two_threads;

inline DipOptions options_for(const std::string& film, FilmModel model = FilmModel::kSheet) {
  DipOptions options;
  options.outline = film::parse_outline(film).value();
  options.film_model = model;
  options.map.make_tiles = false;
  return options;
}

/// Checks the properties that every dip must have, such as numbers or NaN as documented.
inline void expect_sound(const Dip& dip, const DipOptions& options) {
  const flow::SurfaceMap& map = dip.map.surface;
  const std::size_t points = dip.surface.points.size();
  ASSERT_EQ(map.film_mm.size(), points);
  ASSERT_EQ(map.contact_time_s.size(), points);
  ASSERT_EQ(map.stretch.size(), points);
  ASSERT_EQ(map.least_stretch.size(), points);
  for (std::size_t v = 0; v < points; ++v) {
    const bool reached = !std::isnan(map.film_mm[v].x());
    EXPECT_EQ(map.film_mm[v].allFinite(), reached);
    EXPECT_EQ(std::isfinite(map.contact_time_s[v]), reached);
    EXPECT_FALSE(std::isinf(map.stretch[v]));
    EXPECT_FALSE(std::isinf(map.least_stretch[v]));
    if (reached) {
      EXPECT_TRUE(film::contains(options.outline, map.film_mm[v]));
    } else {
      EXPECT_TRUE(std::isnan(map.stretch[v]) && std::isnan(map.least_stretch[v]));
    }
  }
  const DipFigures& f = dip.figures;
  for (const double figure : {f.depth_mm, f.coverage, f.clamped_share, f.unsettled_mm,
                              f.stretch_p50, f.stretch_p95, f.stretch_max}) {
    EXPECT_TRUE(std::isfinite(figure));
  }
  EXPECT_GE(f.coverage, 0);
  EXPECT_LE(f.coverage, 1 + 1e-12);
  EXPECT_LE(f.stretch_p50, f.stretch_p95);
  EXPECT_LE(f.stretch_p95, f.stretch_max);
  for (const Warning& w : dip.warnings) {
    EXPECT_FALSE(w.code == WarningCode::CODE_UNSPECIFIED || w.message.empty());
    EXPECT_EQ(w.message.find('\n'), std::string::npos);
  }
}

/// Runs a dip that must succeed, and checks the properties of every dip.
inline Dip dipped(const mesh::Model& model, const DipOptions& options) {
  auto result = dip(model, options, two_threads());
  if (!result) {
    ADD_FAILURE() << result.error().message;
    return {};
  }
  expect_sound(*result, options);
  return std::move(*result);
}

/// The warning with this code; a warning with an empty code if there is none.
inline Warning warning_of(const Dip& dip, WarningCode code) {
  const auto it = std::find_if(dip.warnings.begin(), dip.warnings.end(),
                               [&](const Warning& w) { return w.code == code; });
  return it == dip.warnings.end() ? Warning{} : *it;
}

inline bool warns(const Dip& dip, WarningCode code) {
  return warning_of(dip, code).code != WarningCode::CODE_UNSPECIFIED;
}

/// Calls `visit` for each point with its position in the film frame, whose z is the immersion, and
/// its film point.
template <class Visit>
void for_each_point(const Dip& dip, Visit&& visit) {
  for (std::size_t v = 0; v < dip.surface.points.size(); ++v) {
    visit(Eigen::Vector3d(dip.X_FO * dip.surface.points[v]), dip.map.surface.film_mm[v]);
  }
}

}  // namespace hydroprint::pipeline::testing
