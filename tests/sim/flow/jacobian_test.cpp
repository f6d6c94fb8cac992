#include "sim/flow/jacobian.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <cmath>
#include <limits>
#include <random>

namespace hydroprint::flow {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
/// Derivative of the map from film to surface.
using Jacobian = Eigen::Matrix<double, 3, 2>;

const std::array<Vector2d, 3> kFilm = {Vector2d(1, 2), Vector2d(3, 2.5), Vector2d(0.5, 4)};

std::array<Vector3d, 3> image(const Jacobian& J) {
  return {J * kFilm[0], J * kFilm[1], J * kFilm[2]};
}

Stretch stretch_by(const Jacobian& J) { return stretch_of(gradient_of(kFilm, image(J))); }

TEST(Stretch, OfRigidMotionsIsOne) {
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(1.1, Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  const Stretch s = stretch_by(R.leftCols<2>());
  EXPECT_NEAR(s.most, 1, 1e-12);
  EXPECT_NEAR(s.least, 1, 1e-12);
}

TEST(Stretch, OfADiagonalIsItsEntries) {
  Jacobian J;
  J << 0, 0.5, 3, 0, 0, 0;
  const Stretch s = stretch_by(J);
  EXPECT_NEAR(s.most, 3, 1e-12);
  EXPECT_NEAR(s.least, 0.5, 1e-12);
}

TEST(Stretch, IsTheSingularValuesOfAnyJacobian) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> entry(-2, 2);
  for (int i = 0; i < 200; ++i) {
    Jacobian J;
    for (double& x : J.reshaped()) x = entry(random);
    const Vector2d expected = Eigen::JacobiSVD<Eigen::MatrixXd>(J).singularValues();
    const Stretch s = stretch_by(J);
    EXPECT_NEAR(s.most / expected[0], 1, 1e-6);
    EXPECT_NEAR(s.least / expected[1], 1, 1e-6);
  }
}

TEST(Stretch, OfFilmStretchedToALineIsInfinite) {
  const Gradient line = gradient_of({Vector2d(0, 0), Vector2d(1, 1), Vector2d(2, 2)},
                                    {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0)});
  EXPECT_TRUE(std::isinf(stretch_of(line).most));
  EXPECT_TRUE(std::isfinite(stretch_of(line).least));
  EXPECT_TRUE(std::isinf(stretch_of(Gradient::Zero()).least));
}

TEST(Gradient, MapsStepsAlongTheSurfaceToStepsOnTheFilm) {
  Jacobian J;
  J << 1, 0.3, -0.2, 2, 0.5, 0.7;
  const auto surface = image(J);
  const Gradient g = gradient_of(kFilm, surface);
  for (int i = 1; i < 3; ++i) {
    EXPECT_LT((g * (surface[i] - surface[0]) - (kFilm[i] - kFilm[0])).norm(), 1e-12);
  }
  const Vector3d normal = (surface[1] - surface[0]).cross(surface[2] - surface[0]);
  EXPECT_LT((g * normal).norm(), 1e-12)
      << "the gradient must not have a component across the surface";
}

TEST(Gradient, OfASurfaceTriangleWithoutAreaIsZero) {
  EXPECT_EQ(gradient_of(kFilm, {Vector3d(1, 1, 1), Vector3d(1, 1, 1), Vector3d(1, 1, 1)}),
            Gradient(Gradient::Zero()));
}

TEST(PointGradients, IgnoreUnreachedAndInvertedTriangles) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  // A square that faces down, so its orientation on the film is reversed.
  const std::vector<Vector3d> surface = {{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}};
  const std::vector<Eigen::Vector3i> triangles = {{0, 1, 2}, {0, 2, 3}};
  const auto flat = [](const Vector3d& p) { return Vector2d(2 * p.head<2>()); };
  std::vector<Vector2d> film;
  for (const Vector3d& p : surface) film.push_back(flat(p));
  for (const Gradient& g : point_gradients(film, surface, triangles)) {
    EXPECT_NEAR(stretch_of(g).most, 0.5, 1e-12);
    EXPECT_NEAR(stretch_of(g).least, 0.5, 1e-12);
  }
  film[3] = Vector2d(nan, nan);
  auto gradients = point_gradients(film, surface, triangles);
  EXPECT_TRUE(std::isnan(gradients[3](0, 0)));
  EXPECT_NEAR(stretch_of(gradients[0]).most, 0.5, 1e-12);
  film[3] = Vector2d(-5, 9);  // moved to the other side, where the other triangle lies
  gradients = point_gradients(film, surface, triangles);
  EXPECT_TRUE(std::isnan(gradients[3](0, 0)));
}

/// Three faces of a cube around one corner, each mapped to the film by a rotation of its own.
struct Corner {
  std::vector<Vector3d> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  std::vector<Eigen::Vector3i> faces = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}};
  std::vector<std::array<Vector2d, 3>> film;

  Corner() {
    for (std::size_t k = 0; k < faces.size(); ++k) {
      const double turn = 0.4 + 1.3 * static_cast<double>(k);
      const Eigen::Rotation2Dd rotation(turn);
      // Seen from above, the film's corners are clockwise.
      film.push_back({Vector2d(5, 5), 5 * Vector2d::Ones() + rotation * Vector2d(0, 1),
                      5 * Vector2d::Ones() + rotation * Vector2d(1, 0)});
    }
  }
};

TEST(PointStretch, OfFilmBentAroundEdgesAndCornersIsOne) {
  const Corner corner;
  for (const Stretch& s : point_stretch(corner.film, corner.points, corner.faces)) {
    EXPECT_NEAR(s.most, 1, 1e-6);
    EXPECT_NEAR(s.least, 1, 1e-6);
  }
}

TEST(PointStretch, IsTheMeanOverTheTrianglesAroundAPoint) {
  Corner corner;
  for (Vector2d& p : corner.film[0]) p /= 2;  // film stretched twofold
  const auto stretch = point_stretch(corner.film, corner.points, corner.faces);
  EXPECT_NEAR(stretch[0].most, (2 + 1 + 1) / 3.0, 1e-9);
  EXPECT_NEAR(stretch[1].most, (2 + 1) / 2.0, 1e-9);
  EXPECT_NEAR(stretch[3].most, 1, 1e-9);
}

TEST(PointStretch, IsInfiniteWithoutATriangle) {
  Corner corner;
  corner.film[0][0].x() = std::numeric_limits<double>::quiet_NaN();
  std::swap(corner.film[1][1], corner.film[1][2]);  // upside down
  const auto stretch = point_stretch(corner.film, corner.points, corner.faces);
  EXPECT_TRUE(std::isinf(stretch[2].most));
  EXPECT_TRUE(std::isinf(stretch[2].least));
  EXPECT_NEAR(stretch[1].most, 1, 1e-9);
}

}  // namespace
}  // namespace hydroprint::flow
