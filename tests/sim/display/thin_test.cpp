#include "sim/display/thin.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include "tests/sim/support/bodies.h"
#include "tests/support/value_of.h"

namespace hydroprint::display {
namespace {

CornerMesh corners_of(const mesh::Model& model) {
  return find_corners(model, image::blank_paint(model), Eigen::Vector3d::Zero());
}

Thinned thinned(const mesh::Model& model, std::size_t most) {
  return testing::value_of(thin(corners_of(model), most, {}));
}

Eigen::Vector3d at(const CornerMesh& mesh, int corner) {
  return mesh.corners[corner].position.cast<double>();
}

double area_of(const CornerMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles)
    sum += (at(mesh, t[1]) - at(mesh, t[0])).cross(at(mesh, t[2]) - at(mesh, t[0])).norm() / 2;
  return sum;
}

/// Volume that the triangles enclose.
double volume_of(const CornerMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles)
    sum += at(mesh, t[0]).dot(at(mesh, t[1]).cross(at(mesh, t[2]))) / 6;
  return sum;
}

TEST(Thin, LeavesASmallMeshAlone) {
  const mesh::Model model = testing::torus(30, 10, 40, 20);
  const Thinned out = thinned(model, model.triangles.size());
  EXPECT_FALSE(out.is_in_part);
  ASSERT_EQ(out.mesh.triangles.size(), model.triangles.size());
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d& want = model.vertices[model.triangles[t][k]];
      EXPECT_LT((at(out.mesh, out.mesh.triangles[t][k]) - want).norm(), 1e-5);
    }
  }
}

TEST(Thin, KeepsTheShapeOfARing) {
  const mesh::Model model = testing::torus(30, 10, 600, 200);
  const Thinned out = thinned(model, 20'000);
  EXPECT_FALSE(out.is_in_part);
  EXPECT_LE(out.mesh.triangles.size(), 20'000U);
  EXPECT_GT(out.mesh.triangles.size(), 8'000U);
  const CornerMesh whole = corners_of(model);
  EXPECT_NEAR(area_of(out.mesh) / area_of(whole), 1, 0.02);
  EXPECT_NEAR(volume_of(out.mesh) / volume_of(whole), 1, 0.02);
  for (const Corner& corner : out.mesh.corners) {
    const Eigen::Vector3d p = corner.position.cast<double>();
    const double from_tube = std::hypot(std::hypot(p.x(), p.y()) - 30, p.z());
    EXPECT_NEAR(from_tube, 10, 0.15) << p.transpose();
  }
}

/// Two parallel squares, 0.1 mm apart, of 200 x 200 cells each.
mesh::Model thin_wall() {
  mesh::Model out;
  constexpr int kCells = 200;
  for (const double z : {0.0, 0.1}) {
    const int first = static_cast<int>(out.vertices.size());
    for (int y = 0; y <= kCells; ++y) {
      for (int x = 0; x <= kCells; ++x) out.vertices.emplace_back(0.5 * x, 0.5 * y, z);
    }
    for (int y = 0; y < kCells; ++y) {
      for (int x = 0; x < kCells; ++x) {
        const int a = first + y * (kCells + 1) + x, b = a + kCells + 1;
        out.triangles.emplace_back(a, a + 1, b + 1);
        out.triangles.emplace_back(a, b + 1, b);
      }
    }
  }
  return out;
}

TEST(Thin, KeepsTheSidesOfAThinWallApart) {
  const Thinned out = thinned(thin_wall(), 5'000);
  EXPECT_FALSE(out.is_in_part);
  int low = 0, high = 0;
  for (const Corner& corner : out.mesh.corners) {
    low += std::abs(corner.position.z()) < 1e-6F ? 1 : 0;
    high += std::abs(corner.position.z() - 0.1F) < 1e-6F ? 1 : 0;
  }
  EXPECT_EQ(static_cast<std::size_t>(low + high), out.mesh.corners.size());
  EXPECT_EQ(low, high);
}

/// A sphere unwrapped by longitude and latitude, with a seam where u jumps from 1 to 0.
mesh::Model unwrapped_sphere(int around, int high) {
  mesh::Model out;
  const auto vertex = [&](int i, int j) { return j * around + i % around; };
  for (int j = 0; j <= high; ++j) {
    for (int i = 0; i < around; ++i) {
      const double turn = 2 * M_PI * i / around, up = M_PI * (j + 0.5) / (high + 1);
      out.vertices.emplace_back(50 * std::sin(up) * std::cos(turn),
                                50 * std::sin(up) * std::sin(turn), 50 * std::cos(up));
    }
  }
  const auto uv = [&](int i, int j) {
    return Eigen::Vector2f(static_cast<float>(i) / static_cast<float>(around),
                           static_cast<float>(j) / static_cast<float>(high));
  };
  for (int j = 0; j < high; ++j) {
    for (int i = 0; i < around; ++i) {
      out.triangles.emplace_back(vertex(i, j), vertex(i, j + 1), vertex(i + 1, j + 1));
      out.corner_uvs.push_back({uv(i, j), uv(i, j + 1), uv(i + 1, j + 1)});
      out.triangles.emplace_back(vertex(i, j), vertex(i + 1, j + 1), vertex(i + 1, j));
      out.corner_uvs.push_back({uv(i, j), uv(i + 1, j + 1), uv(i + 1, j)});
    }
  }
  return out;
}

TEST(Thin, NoTriangleSpansASeamAndNoGapOpensThere) {
  const Thinned out = thinned(unwrapped_sphere(400, 200), 10'000);
  const auto& mesh = out.mesh;
  using Edge = std::pair<std::array<float, 3>, std::array<float, 3>>;
  std::map<Edge, int> edges;
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const Corner &a = mesh.corners[t[k]], &b = mesh.corners[t[(k + 1) % 3]];
      const bool is_at_pole = std::abs(a.position.z()) > 45;  // u changes fast there
      if (!is_at_pole) {
        EXPECT_LT((a.uv - b.uv).cwiseAbs().maxCoeff(), 0.1F);
      }
      const std::array<float, 3> p = {a.position.x(), a.position.y(), a.position.z()},
                                 q = {b.position.x(), b.position.y(), b.position.z()};
      ++edges[std::minmax(p, q)];
    }
  }
  int open = 0;
  for (const auto& [edge, count] : edges) {
    const bool is_at_pole = std::abs(edge.first[2]) > 45;  // the sphere is open at its poles
    open += count == 1 && !is_at_pole ? 1 : 0;
  }
  EXPECT_EQ(open, 0);
}

TEST(Thin, KeepsMaterialsApart) {
  mesh::Model model = thin_wall();
  model.materials = {{}, {}};
  model.materials[0].has_colour = model.materials[1].has_colour = true;
  model.materials[0].colour = {1, 0, 0};
  model.materials[1].colour = {0, 0, 1};
  for (const auto& t : model.triangles)
    model.triangle_material.push_back(model.vertices[t[0]].x() < 50 ? 0 : 1);
  const image::Paint paint = testing::value_of(image::load_paint(model, std::nullopt, {}));
  const Thinned out = testing::value_of(
      thin(find_corners(model, paint, Eigen::Vector3d::Zero()), 5'000, Context{}));
  ASSERT_EQ(out.mesh.ink.size(), out.mesh.triangles.size());
  std::set<int> inks;
  for (std::size_t i = 0; i < out.mesh.triangles.size(); ++i) {
    inks.insert(out.mesh.ink[i]);
    for (const int corner : out.mesh.triangles[i]) {
      EXPECT_EQ(out.mesh.corners[corner].ink, out.mesh.ink[i]);
    }
  }
  EXPECT_EQ(inks.size(), 2U);
}

TEST(Thin, ShowsTheLargestPiecesOfConfetti) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(0, 100), size(0.001, 0.01);
  mesh::Model model;
  for (int i = 0; i < 20'000; ++i) {
    const Eigen::Vector3d p(place(random), place(random), place(random));
    const double s = size(random);
    const int first = static_cast<int>(model.vertices.size());
    model.vertices.insert(model.vertices.end(),
                          {p, p + s * Eigen::Vector3d::UnitX(), p + s * Eigen::Vector3d::UnitY()});
    model.triangles.emplace_back(first, first + 1, first + 2);
  }
  const Thinned out = thinned(model, 2'000);
  EXPECT_TRUE(out.is_in_part);
  EXPECT_EQ(out.mesh.triangles.size(), 2'000U);
  EXPECT_GT(area_of(out.mesh), 0.2 * area_of(corners_of(model)));
  Eigen::AlignedBox3f box;
  for (const Corner& corner : out.mesh.corners) box.extend(corner.position);
  EXPECT_GT(box.sizes().minCoeff(), 98);
}

TEST(Thin, EndsWhenCancelled) {
  Context context;
  context.cancelled = [] { return true; };
  const auto out = thin(corners_of(testing::torus(30, 10, 60, 20)), 100, context);
  ASSERT_FALSE(out);
  EXPECT_EQ(out.error().code, Code::kCancelled);
}

}  // namespace
}  // namespace hydroprint::display
