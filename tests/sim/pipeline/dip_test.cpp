#include "sim/pipeline/dip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "sim/pipeline/pipeline.h"
#include "sim/sample/icosphere.h"
#include "tests/sim/pipeline/dips.h"
#include "tests/sim/support/bodies.h"

namespace hydroprint::pipeline {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
namespace bodies = hydroprint::testing;

using testing::dipped;
using testing::for_each_point;
using testing::options_for;
using testing::two_threads;
using testing::warns;

TEST(Dip, AFlatBottomMapsToItselfAndTheWallsAreReached) {
  const Dip d = dipped(bodies::box({-15, -10, 0}, {15, 10, 20}), options_for("100x90"));
  int bottom = 0, walls = 0, top = 0;
  for_each_point(d, [&](const Vector3d& p, const Vector2d& film) {
    if (p.z() < 1e-9) {
      EXPECT_LT((film - p.head<2>()).norm(), 1e-6) << p.transpose();
      ++bottom;
    } else if (p.z() < 19.99) {
      EXPECT_TRUE(film.allFinite()) << p.transpose();
      EXPECT_TRUE(std::abs(film.x()) > 14.9 || std::abs(film.y()) > 9.9) << p.transpose();
      ++walls;
    } else if (std::abs(p.x()) < 14 && std::abs(p.y()) < 9) {
      EXPECT_FALSE(film.allFinite()) << "the level top must not get film, at " << p.transpose();
      ++top;
    }
  });
  EXPECT_GT(bottom, 100);
  EXPECT_GT(walls, 500);
  EXPECT_GT(top, 50);
  EXPECT_NEAR(d.figures.depth_mm, 20, 1e-9);
  EXPECT_FALSE(d.figures.stopped_at_edge);
  EXPECT_TRUE(warns(d, WarningCode::PARTS_NOT_REACHED));
  EXPECT_TRUE(warns(d, WarningCode::THETA_CLAMPED));
}

TEST(Dip, OnlyACupWithItsMouthDownAndAVentTakesFilmInside) {
  for (const auto& [mouth_up, vent_mm] : {std::pair{false, 2.0}, {false, 0.0}, {true, 0.0}}) {
    const Dip d = dipped(bodies::cup(14, 18, 24, 4, mouth_up, 64, vent_mm), options_for("100x90"));
    int inside = 0;
    for_each_point(d, [&](const Vector3d& p, const Vector2d& film) {
      const double r = p.head<2>().norm();
      const bool is_inner_wall = r < 14.01 && r > 13.9 && p.z() > 4.5 && p.z() < 19.5;
      if (!is_inner_wall) return;
      EXPECT_EQ(film.allFinite(), vent_mm > 0) << p.transpose();
      if (vent_mm > 0) {
        EXPECT_NEAR(film.norm(), r * std::exp(-p.z() / 14), 0.15);
      }
      ++inside;
    });
    EXPECT_GT(inside, 100);
  }
}

TEST(Dip, FilmInsideARingLandsOnItsInside) {
  const Dip d = dipped(bodies::torus(24, 7, 64, 32), options_for("100x90"));
  int inside = 0, outside = 0;
  for_each_point(d, [&](const Vector3d& p, const Vector2d& film) {
    if (p.z() > 7) return;
    const double r = p.head<2>().norm();
    EXPECT_TRUE(film.allFinite()) << p.transpose();
    if (r < 22) {
      EXPECT_LT(film.norm(), r + 0.01);  // film inside the ring is drawn outwards
      ++inside;
    }
    if (r > 26) {
      EXPECT_GT(film.norm(), r - 0.01);
      ++outside;
    }
  });
  EXPECT_GT(inside, 200);
  EXPECT_GT(outside, 200);
}

TEST(Dip, FilmBetweenTwoFeetIsSharedBetweenThem) {
  const Dip d = dipped(bodies::blocks({-20, -10, 10, 20}, {-8, 8}, {0, 16, 24},
                                      [](int i, int, int k) { return k == 1 || i != 1; }),
                       options_for("100x90"));
  int left = 0, right = 0;
  for_each_point(d, [&](const Vector3d& p, const Vector2d& film) {
    const bool faces_gap = std::abs(std::abs(p.x()) - 10) < 1e-6 && p.z() > 0.5 && p.z() < 15.5;
    if (!faces_gap || std::abs(p.y()) > 6) return;
    ASSERT_TRUE(film.allFinite()) << p.transpose();
    EXPECT_GT(film.x() * p.x(), 0)
        << "film must come from this side of the middle, at " << p.transpose();
    EXPECT_LT(std::abs(film.x()), 10 + 1e-6);
    ++(p.x() < 0 ? left : right);
  });
  EXPECT_GT(left, 30);
  EXPECT_EQ(left, right);
}

TEST(Dip, EndsWhereTheObjectReachesTheFilmsEdge) {
  const Dip d = dipped(bodies::wedge(std::numbers::pi / 4, 40, 20), options_for("50x80"));
  EXPECT_TRUE(d.figures.stopped_at_edge);
  EXPECT_TRUE(warns(d, WarningCode::FILM_EDGE_REACHED));
  EXPECT_NEAR(d.figures.depth_mm, 25, 0.06);
  for_each_point(d, [&](const Vector3d& p, const Vector2d& film) {
    if (p.z() > d.figures.depth_mm) {
      EXPECT_FALSE(film.allFinite()) << p.transpose();
    }
    if (p.z() < d.figures.depth_mm - 0.1 && std::abs(p.y()) < 19) {
      EXPECT_TRUE(film.allFinite()) << p.transpose();
    }
  });
}

TEST(Dip, AContactThatMissesTheFilmIsRefused) {
  DipOptions options = options_for("50x80");
  options.X_FO = Pose(Eigen::Translation3d(40, 0, 0));
  const auto d = dip(sample::icosphere(10, 2), options, {});
  ASSERT_FALSE(d);
  EXPECT_EQ(d.error().code, Code::kFailedPrecondition);
  EXPECT_EQ(d.error().reason, ErrorReason::CONTACT_MISSES_FILM);
}

TEST(Dip, GoesNoDeeperThanRequestedOrThanTheObject) {
  for (const double depth : {0.5, 7.0, 1000.0}) {
    DipOptions options = options_for("60x60");
    options.depth_mm = depth;
    const Dip d = dipped(sample::icosphere(10, 3), options);
    const double expected = std::min(depth, 20.0);
    EXPECT_NEAR(d.figures.depth_mm, expected, 1e-9);
    for_each_point(d, [&](const Vector3d& p, const Vector2d& film) {
      if (p.z() > expected) {
        EXPECT_FALSE(film.allFinite());
      } else if (p.z() < 15) {
        EXPECT_TRUE(film.allFinite());
      }
    });
  }
}

TEST(Dip, DepthZeroIsNotAnError) {
  DipOptions options = options_for("60x60");
  options.depth_mm = 0;
  const Dip d = dipped(bodies::box({-5, -5, 0}, {5, 5, 10}), options);
  EXPECT_EQ(d.figures.depth_mm, 0);
}

TEST(Dip, CentresTheObjectByDefault) {
  const mesh::Model model = bodies::moved(sample::icosphere(10, 3), {300, -200, 77});
  DipOptions options = options_for("60x60");
  options.depth_mm = 8;
  const Dip d = dipped(model, options);
  EXPECT_LT((d.X_FO * Vector3d(300, -200, 67)).norm(), 1e-9);
  EXPECT_TRUE(d.X_FO.linear().isIdentity(1e-15));
  double nearest = 1e9;
  for_each_point(d, [&](const Vector3d& p, const Vector2d& film) {
    if (p.z() < 1e-9) nearest = std::min(nearest, film.norm());
  });
  EXPECT_LT(nearest, 1e-6);
}

TEST(Dip, IgnoresTheZOfThePose) {
  const mesh::Model model = sample::icosphere(10, 3);
  std::vector<Dip> dips;
  for (const double z : {0.0, 123.0}) {
    DipOptions options = options_for("60x60");
    options.X_FO = Pose(Eigen::Translation3d(3, -4, z));
    options.depth_mm = 12;
    dips.push_back(dipped(model, options));
  }
  EXPECT_EQ(dips[0].X_FO.matrix(), dips[1].X_FO.matrix());
  for (std::size_t v = 0; v < dips[0].surface.points.size(); ++v) {
    const Vector2d& a = dips[0].map.surface.film_mm[v];
    const Vector2d& b = dips[1].map.surface.film_mm[v];
    EXPECT_TRUE(a == b || (std::isnan(a.x()) && std::isnan(b.x())));
  }
}

TEST(Dip, IsBitIdenticalForOneAndTwoThreads) {
  DipOptions options = options_for("90x80");
  options.map.make_tiles = true;
  options.depth_mm = 16;
  const mesh::Model model = bodies::moved(bodies::torus(18, 6, 48, 24), {5, 3, 0});
  const auto run = [&](int threads) {
    Context context;
    context.threads = threads;
    return dip(model, options, context).value();
  };
  const Dip one = run(1), two = run(2);
  const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  for (std::size_t v = 0; v < one.surface.points.size(); ++v) {
    const auto& a = one.map.surface;
    const auto& b = two.map.surface;
    EXPECT_TRUE(same(a.film_mm[v].x(), b.film_mm[v].x()));
    EXPECT_TRUE(same(a.film_mm[v].y(), b.film_mm[v].y()));
    EXPECT_TRUE(same(a.contact_time_s[v], b.contact_time_s[v]));
    EXPECT_TRUE(same(a.stretch[v], b.stretch[v]));
    EXPECT_TRUE(same(a.least_stretch[v], b.least_stretch[v]));
  }
  ASSERT_EQ(one.map.tiles.size(), two.map.tiles.size());
  for (std::size_t i = 0; i < one.map.tiles.size(); ++i) {
    EXPECT_EQ(one.map.tiles[i].film_mm, two.map.tiles[i].film_mm);
    EXPECT_EQ(one.map.tiles[i].triangle, two.map.tiles[i].triangle);
  }
  EXPECT_EQ(one.figures.stretch_max, two.figures.stretch_max);
}

TEST(Dip, StopsAtAnyStageWhenCancelled) {
  for (const std::string stage : {"surface", "waterline", "velocity", "flow map"}) {
    DipOptions options = options_for("60x60");
    Context context = two_threads();
    std::atomic<bool> stop = false;
    context.report = [&](std::string_view now, double) { stop = stop || now == stage; };
    context.cancelled = [&] { return stop.load(); };
    const auto d = dip(sample::icosphere(10, 3), options, context);
    EXPECT_TRUE(stop) << stage << " must be reported";
    ASSERT_FALSE(d) << stage;
    EXPECT_EQ(d.error().code, Code::kCancelled) << stage;
  }
}

TEST(Dip, ReturnsPointsOfThePrintedFilmWhenItSwells) {
  DipOptions options = options_for("60x60");
  options.profile.swelling = {1.25, 1.1};
  const Dip d = dipped(bodies::box({-5, -5, 0}, {5, 5, 3}), options);
  for_each_point(d, [&](const Vector3d& p, const Vector2d& film) {
    if (p.z() > 1e-9) return;
    EXPECT_LT((film - Vector2d(p.x() / 1.25, p.y() / 1.1)).norm(), 1e-6);
  });
}

TEST(Dip, AcceptsBrokenBodiesAndRefusesSheetsWithoutThickness) {
  mesh::Model broken = sample::icosphere(12, 3);
  broken.triangles.resize(broken.triangles.size() * 4 / 5);
  EXPECT_GT(dipped(broken, options_for("60x60")).figures.coverage, 0.3);
  mesh::Model sheet;
  sheet.path = "sheet";
  sheet.vertices = {{-8, -8, 0}, {8, -8, 0}, {8, 8, 0}, {-8, 8, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  const auto refused = dip(sheet, options_for("60x60"), {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::kInvalidArgument);
  EXPECT_NE(refused.error().message.find("sheet: "), std::string::npos);
  EXPECT_NE(refused.error().message.find("thickness"), std::string::npos);
}

TEST(Dip, RefusesBodiesWithoutSectionsUnlessTheDipIsShort) {
  for (const mesh::Model& thin :
       {bodies::box({0, 0, 0}, {0.01, 0.01, 20}), bodies::box({0, 0, 0}, {20, 20, 1e-4}),
        bodies::box({0, 0, 0}, {1e-3, 1e-3, 1e-3})}) {
    DipOptions options = options_for("60x60");
    const auto refused = dip(thin, options, {});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, Code::kInvalidArgument);
    EXPECT_NE(refused.error().message.find("thickness"), std::string::npos);
    options.depth_mm = 0;
    EXPECT_TRUE(dip(thin, options, {}));
  }
}

TEST(Dip, AcceptsPartsThatTouchUpToRounding) {
  for (const double gap_mm : {1e-3, 1e-5, 2e-6}) {
    pipeline::DipOptions options;
    options.outline = film::parse_outline("80x80").value();
    options.map.make_tiles = false;
    const auto dip = pipeline::dip(bodies::together({bodies::box({-10, -8, 0}, {0, 8, 6}),
                                                     bodies::box({gap_mm, -8, 0}, {10, 8, 6})}),
                                   options, {});
    ASSERT_TRUE(dip) << gap_mm << ": " << dip.error().message;
    EXPECT_LT(dip->figures.film_vertices_max, 5000) << gap_mm;
  }
}

}  // namespace
}  // namespace hydroprint::pipeline
