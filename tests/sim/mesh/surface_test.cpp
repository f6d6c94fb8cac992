#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <string>

#include "sim/mesh/edges.h"
#include "sim/mesh/make_surface.h"
#include "sim/sample/icosphere.h"

namespace hydroprint::mesh {
namespace {

/// An axis-aligned box of quads, each split in two, facing outward.
Model box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  Model model;
  model.path = "box";
  for (int i = 0; i < 8; ++i)
    model.vertices.emplace_back((i & 1) != 0 ? high.x() : low.x(),
                                (i & 2) != 0 ? high.y() : low.y(),
                                (i & 4) != 0 ? high.z() : low.z());
  const int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                           {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& q : quads) {
    model.triangles.emplace_back(q[0], q[1], q[2]);
    model.triangles.emplace_back(q[0], q[2], q[3]);
  }
  return model;
}

Model join(const Model& a, const Model& b) {
  Model both = a;
  const int shift = static_cast<int>(a.vertices.size());
  both.vertices.insert(both.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& t : b.triangles) both.triangles.push_back(t + Eigen::Vector3i::Constant(shift));
  return both;
}

Model turned(Model model) {
  for (auto& t : model.triangles) std::swap(t[1], t[2]);
  return model;
}

/// A copy of a model in which each triangle has its own three points, as in an STL file.
Model torn(const Model& model) {
  Model apart;
  apart.path = model.path;
  for (const auto& t : model.triangles) {
    const int n = static_cast<int>(apart.vertices.size());
    for (int k = 0; k < 3; ++k) apart.vertices.push_back(model.vertices[t[k]]);
    apart.triangles.emplace_back(n, n + 1, n + 2);
  }
  return apart;
}

Surface made(const Model& model, double max_edge_mm = kMaxEdgeMm) {
  auto surface = make_surface(model, max_edge_mm, {});
  if (!surface) {
    ADD_FAILURE() << surface.error().message;
    return {};
  }
  return *surface;
}

bool has_warning(const Surface& surface, WarningCode code) {
  return std::any_of(surface.warnings.begin(), surface.warnings.end(),
                     [&](const Warning& w) { return w.code == code; });
}

double volume(const Surface& s) {
  double sum = 0;
  for (const auto& t : s.triangles)
    sum += s.points[t[0]].dot(s.points[t[1]].cross(s.points[t[2]])) / 6;
  return sum;
}

double area(const std::vector<Eigen::Vector3d>& points, const std::vector<Eigen::Vector3i>& faces) {
  double sum = 0;
  for (const auto& t : faces)
    sum += (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]).norm() / 2;
  return sum;
}

double longest_edge(const Surface& s) {
  double longest = 0;
  for (const auto& t : s.triangles)
    for (int k = 0; k < 3; ++k)
      longest = std::max(longest, (s.points[t[k]] - s.points[t[(k + 1) % 3]]).norm());
  return longest;
}

/// Number of welded edges that do not have exactly two sides with opposite directions.
std::size_t bad_edges(const Surface& s) {
  std::size_t bad = 0;
  const Edges edges(s.triangles, s.weld);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto sides = edges.sides(e);
    if (sides.size() != 2 || side_ends(sides[0], s.triangles, s.weld).from ==
                                 side_ends(sides[1], s.triangles, s.weld).from)
      ++bad;
  }
  return bad;
}

TEST(MakeSurface, FineModelKeepsItsPointsAndTriangles) {
  const Model model = sample::icosphere(20, 4);
  const Surface surface = made(model);
  EXPECT_EQ(surface.points, model.vertices);
  EXPECT_EQ(surface.triangles, model.triangles);
  EXPECT_TRUE(surface.closed);
  EXPECT_TRUE(surface.warnings.empty());
}

TEST(MakeSurface, LongEdgesAreHalvedUntilNoneExceedsTheLimit) {
  const Model model = box({-60, -60, 0}, {60, 60, 10});
  const Surface surface = made(model);
  EXPECT_LE(longest_edge(surface), 2);
  EXPECT_NEAR(area(surface.points, surface.triangles), 2 * 120 * 120 + 4 * 120 * 10, 1e-6);
  EXPECT_NEAR(volume(surface), 120 * 120 * 10, 1e-6);
  EXPECT_EQ(bad_edges(surface), 0U);
  EXPECT_TRUE(surface.closed);
}

TEST(MakeSurface, ModelsOwnVerticesComeFirstInItsOrder) {
  const Model model = torn(box({0, 0, 0}, {30, 20, 10}));
  const Surface surface = made(model);
  ASSERT_GT(surface.points.size(), model.vertices.size());
  EXPECT_TRUE(std::equal(model.vertices.begin(), model.vertices.end(), surface.points.begin()));
}

TEST(MakeSurface, NeighboursAgreeOnNewPointsAcrossTornSeams) {
  const Surface surface = made(torn(box({0, 0, 0}, {30, 20, 10})));
  EXPECT_TRUE(surface.closed);
  EXPECT_EQ(bad_edges(surface), 0U);
  EXPECT_NEAR(volume(surface), 30 * 20 * 10, 1e-9);
}

TEST(MakeSurface, NeedlesAreSubdividedConformingly) {
  Model model = box({0, 0, 0}, {90, 0.01, 0.02});
  const Surface surface = made(model);
  EXPECT_LE(longest_edge(surface), 2);
  EXPECT_EQ(bad_edges(surface), 0U);
  EXPECT_LT(surface.triangles.size(), 10000U);
}

TEST(MakeSurface, BarycentricsLeadBackToTheSourceTriangle) {
  // The box is turned inside out, which also swaps corners.
  const Model model = turned(torn(box({0, 0, 0}, {30, 20, 10})));
  const Surface surface = made(model);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& source = model.triangles[surface.source_triangle[t]];
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d b = surface.source_barycentric[t][k].cast<double>();
      const Eigen::Vector3d p = b[0] * model.vertices[source[0]] +
                                b[1] * model.vertices[source[1]] + b[2] * model.vertices[source[2]];
      EXPECT_LT((p - surface.points[surface.triangles[t][k]]).norm(), 1e-5);
    }
  }
}

TEST(MakeSurface, WeldNamesTheFirstPointAtTheSamePlace) {
  const Model model = torn(box({0, 0, 0}, {1, 1, 1}));
  const Surface surface = made(model);
  std::set<int> places;
  for (std::size_t i = 0; i < model.vertices.size(); ++i) {
    const auto first = std::find(model.vertices.begin(), model.vertices.end(), model.vertices[i]);
    EXPECT_EQ(surface.weld[i], first - model.vertices.begin());
    places.insert(surface.weld[i]);
  }
  EXPECT_EQ(places.size(), 8U);
}

TEST(MakeSurface, RoundingErrorsDoNotTearTheSurface) {
  Model model = torn(sample::icosphere(50, 3));
  std::mt19937 random(7);
  std::uniform_real_distribution<double> noise(-1e-8, 1e-8);
  for (auto& v : model.vertices) v += Eigen::Vector3d(noise(random), noise(random), noise(random));
  EXPECT_TRUE(made(model).closed);
}

TEST(MakeSurface, CornerNormalsOfASphereAreRadialWithinAFifthOfADegree) {
  const Surface surface = made(sample::icosphere(40, 6));
  double worst = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d radial = surface.points[surface.triangles[t][k]].normalized();
      EXPECT_NEAR(surface.corner_normals[t][k].norm(), 1, 1e-12);
      worst = std::max(worst, radial.cross(surface.corner_normals[t][k]).norm());
    }
  EXPECT_LT(worst, std::sin(0.2 * M_PI / 180));
}

TEST(MakeSurface, CornerNormalsOfABoxAreItsFaceNormals) {
  const Surface surface = made(torn(box({-5, -5, -5}, {5, 5, 5})));
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& tri = surface.triangles[t];
    const Eigen::Vector3d middle =
        (surface.points[tri[0]] + surface.points[tri[1]] + surface.points[tri[2]]) / 3;
    Eigen::Vector3d face = Eigen::Vector3d::Zero();
    Eigen::Index axis = 0;
    (void)middle.cwiseAbs().maxCoeff(&axis);
    face[axis] = middle[axis] > 0 ? 1 : -1;
    for (int k = 0; k < 3; ++k) EXPECT_LT((surface.corner_normals[t][k] - face).norm(), 1e-12);
  }
}

TEST(MakeSurface, InsideOutModelIsTurnedOverWithAWarning) {
  const Surface surface = made(turned(sample::icosphere(10, 3)));
  EXPECT_GT(volume(surface), 0);
  EXPECT_TRUE(has_warning(surface, WarningCode::INSIDE_OUT));
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    EXPECT_GT(surface.corner_normals[t][0].dot(surface.points[surface.triangles[t][0]]), 0);
}

TEST(MakeSurface, AFewTurnedFacesFollowTheirNeighbours) {
  Model model = sample::icosphere(10, 3);
  for (std::size_t t = 5; t < model.triangles.size(); t += 3)
    std::swap(model.triangles[t][0], model.triangles[t][1]);
  const Surface surface = made(model);
  EXPECT_TRUE(surface.closed);
  EXPECT_GT(volume(surface), 0);
  EXPECT_TRUE(has_warning(surface, WarningCode::INCONSISTENT_ORIENTATION));
}

TEST(MakeSurface, OneShellInsideOutAmongTwoIsTurnedOver) {
  const Model a = box({0, 0, 0}, {20, 20, 20});
  const Model b = box({30, 0, 0}, {40, 10, 10});
  const Surface surface = made(join(a, turned(b)));
  EXPECT_NEAR(volume(surface), 8000 + 1000, 1e-6);
  EXPECT_TRUE(has_warning(surface, WarningCode::INSIDE_OUT));
  EXPECT_TRUE(has_warning(surface, WarningCode::MANY_SHELLS));
}

TEST(MakeSurface, ACavityInsideAnotherShellStaysACavity) {
  const Surface surface =
      made(join(box({0, 0, 0}, {20, 20, 20}), turned(box({5, 5, 5}, {15, 15, 15}))));
  EXPECT_NEAR(volume(surface), 8000 - 1000, 1e-6);
  EXPECT_FALSE(has_warning(surface, WarningCode::INSIDE_OUT));
}

TEST(MakeSurface, OpenMeshIsReportedWithItsBoundaryEdges) {
  Model model = box({0, 0, 0}, {10, 10, 10});
  model.triangles.resize(10);  // removes the last quad
  const Surface surface = made(model);
  EXPECT_FALSE(surface.closed);
  ASSERT_TRUE(has_warning(surface, WarningCode::MESH_OPEN));
  EXPECT_TRUE(surface.warnings.front().message.starts_with(
      "the mesh has 4 boundary edges in 1 hole (40 mm around (10.0, 5.0, 5.0) mm)"));
  EXPECT_FALSE(has_warning(surface, WarningCode::INSIDE_OUT));
}

TEST(MakeSurface, OpenMeshInsideOutIsTurnedOver) {
  Model model = box({100, 0, 0}, {110, 10, 10});
  model.triangles.resize(10);
  EXPECT_TRUE(has_warning(made(turned(model)), WarningCode::INSIDE_OUT));
}

TEST(MakeSurface, ThreeFacesAtOneEdgeAreNonManifold) {
  Model model = box({0, 0, 0}, {10, 10, 10});
  model.vertices.emplace_back(-10, -10, 5);
  model.triangles.emplace_back(0, 4, 8);
  EXPECT_TRUE(has_warning(made(model), WarningCode::MESH_NON_MANIFOLD));
}

TEST(MakeSurface, AModelGivenTwiceIsOneSolidWhicheverWayRoundItsCopyIs) {
  const Model ball = sample::icosphere(20, 3);
  const Surface once = made(ball);
  for (const Model& copy : {ball, turned(ball)}) {
    for (const Model& both : {join(ball, copy), torn(join(ball, copy)), join(copy, ball)}) {
      const Surface surface = made(both);
      EXPECT_TRUE(surface.closed);
      EXPECT_TRUE(has_warning(surface, WarningCode::COINCIDENT_FACES));
      EXPECT_FALSE(has_warning(surface, WarningCode::MANY_SHELLS));
      EXPECT_EQ(surface.triangles.size(), once.triangles.size());
      EXPECT_NEAR(volume(surface), volume(once), 1e-9 * volume(once));
    }
  }
}

TEST(MakeSurface, PartsThatTouchAreUnitedWithoutTheWallBetweenThem) {
  const Model left = box({0, 0, 0}, {10, 10, 10}), right = box({10, 0, 0}, {20, 10, 10});
  const Surface two = made(join(left, right));
  EXPECT_TRUE(two.closed);
  EXPECT_TRUE(has_warning(two, WarningCode::PARTS_TOUCH));
  EXPECT_FALSE(has_warning(two, WarningCode::COINCIDENT_FACES));
  EXPECT_NEAR(volume(two), 2000, 1e-6);
  EXPECT_NEAR(area(two.points, two.triangles), 2 * 100 + 4 * 200, 1e-6);
  // Four boxes around an edge: their walls cross there.
  const Model back = box({0, 10, 0}, {10, 20, 10}), corner = box({10, 10, 0}, {20, 20, 10});
  const Surface four = made(join(join(left, right), join(back, corner)));
  EXPECT_TRUE(four.closed);
  EXPECT_NEAR(volume(four), 4000, 1e-6);
  EXPECT_NEAR(area(four.points, four.triangles), 2 * 400 + 4 * 200, 1e-6);
}

TEST(MakeSurface, WallsThatOnlyMeetOtherWallsAreDroppedToo) {
  // 4 x 4 x 4 boxes: the walls in the middle reach no face of the outside.
  Model block;
  for (int i = 0; i < 64; ++i) {
    const Eigen::Vector3d low = 10 * Eigen::Vector3d(i % 4, i / 4 % 4, i / 16);
    block = join(block, box(low, low + Eigen::Vector3d::Constant(10)));
  }
  const Surface surface = made(block);
  EXPECT_TRUE(surface.closed);
  EXPECT_FALSE(has_warning(surface, WarningCode::COINCIDENT_FACES));
  EXPECT_NEAR(volume(surface), 64'000, 1e-6);
  EXPECT_NEAR(area(surface.points, surface.triangles), 6 * 1600, 1e-6);
}

/// Returns the area of the triangles that do not lie inside another part.
double outer_area(const Surface& s) {
  double sum = 0;
  for (std::size_t t = 0; t < s.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      if (!s.is_inner(t, k)) sum += area(s.points, {s.triangles[t]}) / 3;
  return sum;
}

/// 3 x 3 x 3 boxes. The faces of every second one are divided along their other diagonals.
Model blocks_with_mixed_diagonals() {
  Model block;
  for (int i = 0; i < 27; ++i) {
    const Eigen::Vector3d low = 10 * Eigen::Vector3d(i % 3, i / 3 % 3, i / 9);
    Model one = box(low, low + Eigen::Vector3d::Constant(10));
    for (std::size_t t = 0; i % 2 == 0 && t < 12; t += 2) {
      const Eigen::Vector3i a = one.triangles[t], b = one.triangles[t + 1];
      one.triangles[t] = {a[0], a[1], b[2]};
      one.triangles[t + 1] = {b[2], a[1], a[2]};
    }
    block = join(block, one);
  }
  return block;
}

TEST(MakeSurface, SolidsWhoseCommonWallsAreDividedDifferentlyStayOriented) {
  for (const Model& given :
       {blocks_with_mixed_diagonals(), turned(blocks_with_mixed_diagonals())}) {
    const Surface surface = made(given);
    EXPECT_NEAR(volume(surface), 27'000, 1e-6);
    EXPECT_NEAR(outer_area(surface), 6 * 900, 1e-6);
    EXPECT_FALSE(has_warning(surface, WarningCode::SIDES_BY_RAYS));
  }
}

TEST(MakeSurface, SolidsThatShareAnEdgeFaceOutwardWhicheverWayTheyAreGiven) {
  const Model low = box({0, 0, 0}, {10, 10, 10}), high = box({10, 10, 0}, {20, 20, 10});
  for (const Model& given : {join(low, high), join(low, turned(high)), join(turned(low), high),
                             join(turned(low), turned(high))})
    EXPECT_NEAR(volume(made(given)), 2000, 1e-6);
}

TEST(MakeSurface, FacesInsideAnotherPartAreInner) {
  // Two balls whose centres are a radius apart: of each, the cap beyond the middle plane is
  // outside.
  Model left = sample::icosphere(20, 4), right = left;
  for (auto& p : right.vertices) p.x() += 20;
  const Surface both = made(join(left, right), 1);
  const double pi = 3.14159265358979;
  EXPECT_NEAR(outer_area(both), 2 * (2 * pi * 20 * 30), 0.01 * 2 * 2 * pi * 20 * 30);
  // A ball within a box: all of it is inner. A cavity: its wall is not.
  const Model block = box({-30, -30, -30}, {30, 30, 30});
  EXPECT_NEAR(outer_area(made(join(block, left), 5)), 6 * 3600, 1e-6);
  const Surface hollow = made(join(block, turned(left)), 5);
  EXPECT_TRUE(hollow.inner.empty());
  EXPECT_TRUE(made(left).inner.empty());
  // An open part hides nothing.
  Model open = block;
  open.triangles.resize(10);
  EXPECT_TRUE(made(join(open, left), 5).inner.empty());
}

TEST(MakeSurface, ADoubleSidedSheetStaysOneSheetWithoutThickness) {
  Model plate;
  plate.path = "plate";
  plate.vertices = {{0, 0, 0}, {30, 0, 0}, {30, 30, 0}, {0, 30, 0}};
  plate.triangles = {{0, 1, 2}, {0, 2, 3}};
  const Surface surface = made(join(plate, turned(plate)));
  EXPECT_TRUE(surface.is_flat);
  EXPECT_TRUE(has_warning(surface, WarningCode::COINCIDENT_FACES));
  EXPECT_NEAR(area(surface.points, surface.triangles), 900, 1e-9);
  EXPECT_FALSE(made(box({0, 0, 0}, {30, 30, 0.1})).is_flat);
}

TEST(MakeSurface, FacesWithoutAreaAreDroppedWithAWarning) {
  Model model = box({0, 0, 0}, {10, 10, 10});
  model.triangles.emplace_back(0, 0, 1);
  const Surface surface = made(model);
  EXPECT_TRUE(has_warning(surface, WarningCode::ZERO_AREA_FACES));
  EXPECT_TRUE(surface.closed);
}

TEST(MakeSurface, OnlyFacesWithoutAreaAreRefused) {
  Model model;
  model.path = "line.obj";
  model.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  model.triangles = {{0, 1, 2}};
  const auto surface = make_surface(model, kMaxEdgeMm, {});
  ASSERT_FALSE(surface);
  EXPECT_EQ(surface.error().code, Code::kInvalidArgument);
  EXPECT_NE(surface.error().message.find("line.obj"), std::string::npos);
}

TEST(MakeSurface, ProbablyWrongUnitsAreReported) {
  EXPECT_TRUE(
      has_warning(made(box({0, 0, 0}, {0.1, 0.1, 0.1})), WarningCode::SMALL_OR_LARGE_OBJECT));
  EXPECT_TRUE(
      has_warning(made(box({0, 0, 0}, {1500, 10, 10}), 50), WarningCode::SMALL_OR_LARGE_OBJECT));
  EXPECT_FALSE(
      has_warning(made(box({0, 0, 0}, {100, 10, 10})), WarningCode::SMALL_OR_LARGE_OBJECT));
}

TEST(MakeSurface, TheLikelyUnitIsNamedWithItsFactor) {
  const auto message = [](double side, double scale, const char* path) {
    Model model = box({0, 0, 0}, {side, side / 2, side / 2});
    model.path = path;
    model.scale = scale;
    const auto surface = make_surface(model, side, {});
    for (const Warning& w : surface->warnings)
      if (w.code == WarningCode::SMALL_OR_LARGE_OBJECT) return w.message;
    return std::string();
  };
  EXPECT_NE(message(0.25, 1, "a.glb").find("metres, the scale is 1000, and it is 250 mm"),
            std::string::npos);
  EXPECT_NE(message(0.25, 1, "a.obj").find("metres, the scale is 1000"), std::string::npos);
  EXPECT_NE(message(4, 1, "a.stl").find("inches, the scale is 25.4, and it is 102 mm"),
            std::string::npos);
  EXPECT_NE(message(80'000, 1, "a.stl").find("micrometres, the scale is 0.001"), std::string::npos);
  EXPECT_NE(message(2000, 1000, "a.stl").find("inches, the scale is 25.4, and it is 50.8 mm"),
            std::string::npos);
  EXPECT_NE(message(1e-4, 1, "a.stl").find("check the scale"), std::string::npos);
  EXPECT_EQ(message(80, 1, "a.stl"), "");
}

TEST(MakeSurface, TooManyTrianglesAreRefusedWithTheRemedy) {
  const auto surface = make_surface(box({0, 0, 0}, {1e6, 1e6, 1e6}), kMaxEdgeMm, {});
  ASSERT_FALSE(surface);
  EXPECT_EQ(surface.error().code, Code::kResourceExhausted);
  EXPECT_NE(surface.error().message.find("smaller scale"), std::string::npos);
}

TEST(MakeSurface, AnEdgeLengthThatIsNotPositiveIsRefused) {
  for (const double length : {0.0, -1.0, std::nan("")}) {
    const auto surface = make_surface(box({0, 0, 0}, {1, 1, 1}), length, {});
    ASSERT_FALSE(surface);
    EXPECT_EQ(surface.error().code, Code::kInvalidArgument);
  }
}

TEST(MakeSurface, StopsWhenCancelled) {
  Context context;
  context.cancelled = [] { return true; };
  const auto surface = make_surface(box({0, 0, 0}, {100, 100, 100}), kMaxEdgeMm, context);
  ASSERT_FALSE(surface);
  EXPECT_EQ(surface.error().code, Code::kCancelled);
}

TEST(MakeSurface, AStripWithOneSideIsReportedAndKept) {
  Model model;
  model.path = "moebius";
  const int n = 40;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * M_PI * i / n;
    const Eigen::Vector3d radial(std::cos(a), std::sin(a), 0);
    const Eigen::Vector3d across =
        std::cos(a / 2) * radial + std::sin(a / 2) * Eigen::Vector3d::UnitZ();
    model.vertices.push_back(30 * radial - 5 * across);
    model.vertices.push_back(30 * radial + 5 * across);
  }
  for (int i = 0; i < n; ++i) {
    const bool last = i + 1 == n;  // the Moebius strip closes with its sides swapped
    const int c = last ? 1 : 2 * i + 2;
    const int d = last ? 0 : 2 * i + 3;
    model.triangles.emplace_back(2 * i, c, 2 * i + 1);
    model.triangles.emplace_back(2 * i + 1, c, d);
  }
  const Surface surface = made(model);
  EXPECT_TRUE(has_warning(surface, WarningCode::INCONSISTENT_ORIENTATION));
  EXPECT_FALSE(surface.closed);
  EXPECT_TRUE(surface.is_flat);
}

TEST(Icosphere, HasTheTrianglesOfItsLevelAndFacesOutward) {
  const Model model = sample::icosphere(40, 6);
  EXPECT_EQ(model.triangles.size(), 81920U);
  EXPECT_EQ(model.vertices.size(), 40962U);
  const Surface surface = made(model);
  EXPECT_TRUE(surface.closed);
  EXPECT_TRUE(surface.warnings.empty());
  for (const auto& v : model.vertices) EXPECT_NEAR(v.norm(), 40, 1e-12);
  EXPECT_EQ(model.vertices.front(), Eigen::Vector3d(0, 0, -40));
}

}  // namespace
}  // namespace hydroprint::mesh
