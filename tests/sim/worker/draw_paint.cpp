// hydroprint-draw-paint: draws an object with its paint as the worker computes it, without light
// and film, for comparison with what the pages draw. Parallel view; the middle of the bounding box
// is in the middle of the picture.
#include <CLI/CLI.hpp>
#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "proto/paint/paint_file.h"
#include "sim/image/io/colour.h"
#include "sim/image/io/image_file.h"
#include "sim/image/layers/surface_paint.h"
#include "sim/mesh/make_surface.h"
#include "sim/mesh/read/read_model.h"
#include "sim/worker/common/input_folder.h"
#include "sim/worker/common/paint.h"

namespace hydroprint::worker {
namespace {

struct Options {
  std::string mesh, paint, out;
  int pixels = 256;
  double half_mm = 50;
  std::vector<double> direction = {0, 1, 0}, up = {0, 0, 1};
};

/// A parallel projection onto a square of pixels.
class Camera {
 public:
  Camera(const Options& options, const mesh::Surface& surface) : options_(options) {
    const Eigen::Vector3d d = Eigen::Vector3d(options.direction.data()).normalized();
    const Eigen::Vector3d up(options.up.data());
    const Eigen::Vector3d u = (up - up.dot(d) * d).normalized();
    axes_ << d.cross(u), u, d;
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& p : surface.points) box.extend(p);
    centre_ = box.center();
  }

  /// Returns the place in pixels, y down, and the depth in mm.
  [[nodiscard]] Eigen::Vector3d project(const Eigen::Vector3d& p) const {
    const Eigen::Vector3d q = axes_.transpose() * (p - centre_);
    const double scale = options_.pixels / (2 * options_.half_mm);
    return {options_.pixels / 2.0 + q.x() * scale, options_.pixels / 2.0 - q.y() * scale, q.z()};
  }

 private:
  const Options& options_;
  Eigen::Matrix3d axes_;
  Eigen::Vector3d centre_;
};

/// A picture while triangles are drawn.
struct Canvas {
  int pixels = 0;
  std::vector<double> depth;
  std::vector<std::uint8_t> rgba;
};

void draw(const mesh::Surface& surface, const image::SurfacePaint& paint, int triangle,
          const Camera& camera, Canvas& canvas) {
  flow::MappedTriangle tile;
  tile.triangle = triangle;
  image::Corners at;
  Eigen::Vector3d depth;
  for (int i = 0; i < 3; ++i) {
    const auto v =
        static_cast<std::size_t>(surface.triangles[static_cast<std::size_t>(triangle)][i]);
    const Eigen::Vector3d place = camera.project(surface.points[v]);
    at[static_cast<std::size_t>(i)] = place.head<2>();
    depth[i] = place.z();
    tile.barycentric[static_cast<std::size_t>(i)] = Eigen::Vector3f::Unit(i);
  }
  const image::SurfaceBrush brush = paint.brush(surface, tile, at);
  const auto paint_pixel = [&](int x, int y, const Eigen::Vector3d& b) {
    const std::size_t pixel = static_cast<std::size_t>(y) * canvas.pixels + x;
    if (b.dot(depth) >= canvas.depth[pixel]) return;
    canvas.depth[pixel] = b.dot(depth);
    const Eigen::Vector3f light = brush.at(x + 0.5, y + 0.5);
    for (int c = 0; c < 3; ++c)
      canvas.rgba[4 * pixel + static_cast<std::size_t>(c)] = image::srgb8_from_linear(light[c]);
    canvas.rgba[4 * pixel + 3] = 255;
  };
  image::for_each_sample(at, {0, 0, canvas.pixels, canvas.pixels}, paint_pixel);
}

Status run(const Options& options) {
  HP_ASSIGN_OR_RETURN(const v1::Paint paint, paint::read_paint_file(options.paint));
  HP_ASSIGN_OR_RETURN(const mesh::Model model, mesh::read_model(options.mesh, 1, {}));
  HP_ASSIGN_OR_RETURN(const mesh::Surface surface, mesh::make_surface(model, mesh::kMaxEdgeMm, {}));
  HP_ASSIGN_OR_RETURN(const image::LayeredPaint layers,
                      image::load_layers(model, paint_source_of(paint, InputFolder({})),
                                         Eigen::Matrix3d::Identity(), {}));
  HP_ASSIGN_OR_RETURN(const image::SurfacePaint fitted,
                      image::SurfacePaint::fit(layers, surface, {}));
  const Camera camera(options, surface);
  const auto count = static_cast<std::size_t>(options.pixels) * options.pixels;
  Canvas canvas{options.pixels, std::vector<double>(count, HUGE_VAL),
                std::vector<std::uint8_t>(4 * count, 0)};
  for (int t = 0; t < static_cast<int>(surface.triangles.size()); ++t)
    draw(surface, fitted, t, camera, canvas);
  return image::write_png_rgba(options.out, options.pixels, options.pixels, canvas.rgba);
}

}  // namespace
}  // namespace hydroprint::worker

int main(int argc, char** argv) {
  hydroprint::worker::Options options;
  CLI::App app("Draws an object with its paint, without light.");
  app.add_option("--mesh", options.mesh)->required();
  app.add_option("--paint", options.paint)->required();
  app.add_option("--out", options.out)->required();
  app.add_option("--pixels", options.pixels)->check(CLI::Range(1, 8192));
  app.add_option("--half-mm", options.half_mm)->check(CLI::PositiveNumber);
  app.add_option("--direction", options.direction)->delimiter(',')->expected(3);
  app.add_option("--up", options.up)->delimiter(',')->expected(3);
  CLI11_PARSE(app, argc, argv);
  const hydroprint::Status status = hydroprint::worker::run(options);
  if (status) return 0;
  std::fprintf(stderr, "hydroprint-draw-paint: %s\n", status.error().message.c_str());
  return 1;
}
