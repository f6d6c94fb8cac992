#pragma once

#include <unistd.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "sim/flow/surface_map.h"
#include "sim/image/film/film_image.h"
#include "sim/image/io/image_file.h"
#include "sim/mesh/model.h"
#include "sim/mesh/surface.h"

namespace hydroprint::image::testing {

inline constexpr std::array<int, 3> kWhite = {255, 255, 255}, kBlack = {0, 0, 0},
                                    kGrey = {128, 128, 128}, kRed = {255, 0, 0},
                                    kGreen = {0, 255, 0}, kBlue = {0, 0, 255};

/// A folder for one test, removed when the test ends.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "image-test-XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

inline RgbImage make_image(int width, int height,
                           const std::function<std::array<int, 3>(int, int)>& colour) {
  RgbImage image{width, height,
                 std::vector<std::uint8_t>(3 * static_cast<std::size_t>(width) *
                                           static_cast<std::size_t>(height))};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto rgb = colour(x, y);
      for (int c = 0; c < 3; ++c) image.at(x, y)[c] = static_cast<std::uint8_t>(rgb[c]);
    }
  }
  return image;
}

inline film::Outline rectangle(double width_mm, double height_mm) {
  film::Outline outline;
  outline.min_mm = {-width_mm / 2, -height_mm / 2};
  outline.max_mm = {width_mm / 2, height_mm / 2};
  outline.polygon = {outline.min_mm,
                     {outline.max_mm.x(), outline.min_mm.y()},
                     outline.max_mm,
                     {outline.min_mm.x(), outline.max_mm.y()}};
  outline.name = "test film";
  return outline;
}

/// A flat rectangle in the plane z = 0 as `n` by `m` pairs of triangles; UVs cover all of it.
inline mesh::Model plate(double x0, double y0, double x1, double y1, int n = 1, int m = 1) {
  mesh::Model model;
  model.path = "plate.obj";
  for (int j = 0; j <= m; ++j) {
    for (int i = 0; i <= n; ++i) {
      model.vertices.emplace_back(x0 + (x1 - x0) * i / n, y0 + (y1 - y0) * j / m, 0.0);
    }
  }
  const auto uv = [&](int v) {
    return Eigen::Vector2f(static_cast<float>(v % (n + 1)) / static_cast<float>(n),
                           static_cast<float>(v / (n + 1)) / static_cast<float>(m));
  };
  for (int j = 0; j < m; ++j) {
    for (int i = 0; i < n; ++i) {
      const int v = j * (n + 1) + i;
      for (const Eigen::Vector3i& t :
           {Eigen::Vector3i(v, v + 1, v + n + 2), Eigen::Vector3i(v, v + n + 2, v + n + 1)}) {
        model.triangles.push_back(t);
        model.corner_uvs.push_back({uv(t[0]), uv(t[1]), uv(t[2])});
      }
    }
  }
  return model;
}

inline mesh::Surface surface_of(const mesh::Model& model) {
  const Eigen::Vector3f x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  mesh::Surface surface;
  surface.points = model.vertices;
  surface.triangles = model.triangles;
  for (std::size_t t = 0; t < model.triangles.size(); ++t) {
    surface.source_triangle.push_back(static_cast<int>(t));
    surface.source_barycentric.push_back({x, y, z});
    const auto& f = model.triangles[t];
    const Eigen::Vector3d normal = (model.vertices[f[1]] - model.vertices[f[0]])
                                       .cross(model.vertices[f[2]] - model.vertices[f[0]])
                                       .normalized();
    surface.corner_normals.push_back({normal, normal, normal});
  }
  for (std::size_t v = 0; v < model.vertices.size(); ++v) {
    surface.weld.push_back(static_cast<int>(v));
  }
  return surface;
}

/// One tile per triangle. `map` returns the film point for a point of the object.
inline std::vector<flow::MappedTriangle> tiles_of(
    const mesh::Surface& surface,
    const std::function<Eigen::Vector2d(const Eigen::Vector3d&)>& map) {
  std::vector<flow::MappedTriangle> tiles;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    flow::MappedTriangle tile;
    tile.triangle = static_cast<int>(t);
    for (int i = 0; i < 3; ++i) {
      tile.film_mm[i] = map(surface.points[surface.triangles[t][i]]);
      tile.barycentric[i] = Eigen::Vector3f::Unit(i);
      tile.contact_time_s[i] = 1;
    }
    tiles.push_back(tile);
  }
  return tiles;
}

inline std::vector<flow::MappedTriangle> identity_tiles(const mesh::Surface& surface) {
  return tiles_of(surface, [](const Eigen::Vector3d& p) { return Eigen::Vector2d(p.head<2>()); });
}

}  // namespace hydroprint::image::testing
