// Writes the models that tests/bench/run passes to the worker: a bundled sample, or an icosphere as
// OBJ, plain or with the texture coordinates of the globe (longitude and latitude).
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include "sim/sample/icosphere.h"
#include "sim/sample/sample.h"
#include "tests/bench/figures.h"

namespace hydroprint::bench {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Longitude and latitude, scaled to [0, 1]. The longitude is shifted by a full turn if that brings
/// it closer to `near_u`, so in faces across the date line it may lie outside [0, 1].
Vector2d uv_of(const Vector3d& p, double near_u) {
  const double u = std::atan2(p.y(), p.x()) / (2 * std::numbers::pi) + 0.5;
  return {u + std::round(near_u - u), std::asin(p.z() / p.norm()) / std::numbers::pi + 0.5};
}

void write_uvs(const mesh::Model& model, std::ofstream& out) {
  for (const Eigen::Vector3i& t : model.triangles) {
    const Vector3d middle = model.vertices[t[0]] + model.vertices[t[1]] + model.vertices[t[2]];
    const double u = uv_of(middle, 0.5).x();
    for (const int v : t) {
      const Vector2d uv = uv_of(model.vertices[v], u);
      out << "vt " << uv.x() << ' ' << uv.y() << '\n';
    }
  }
}

int write_icosphere(double radius_mm, int subdivisions, bool with_uvs,
                    const std::filesystem::path& path) {
  const mesh::Model model = sample::icosphere(radius_mm, subdivisions);
  std::ofstream out(path);
  out.precision(9);
  for (const Vector3d& p : model.vertices) {
    out << "v " << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
  }
  if (with_uvs) write_uvs(model, out);
  std::size_t uv = 0;
  for (const Eigen::Vector3i& t : model.triangles) {
    out << 'f';
    for (const int v : t) {
      out << ' ' << v + 1;
      if (with_uvs) out << '/' << ++uv;
    }
    out << '\n';
  }
  return out.flush() ? 0 : 1;
}

int usage() {
  std::fputs(
      "usage: bench_body sample KIND FOLDER\n"
      "       bench_body icosphere|textured-icosphere RADIUS SUBDIVISIONS FILE.obj\n",
      stderr);
  return 2;
}

}  // namespace
}  // namespace hydroprint::bench

int main(int argc, char** argv) {
  using namespace hydroprint;
  const std::string verb = argc > 1 ? argv[1] : "";
  if (verb == "sample" && argc == 4) {
    if (const Status done = sample::write_sample(argv[2], argv[3]); !done) {
      bench::give_up(done.error());
    }
    return 0;
  }
  const bool with_uvs = verb == "textured-icosphere";
  if ((verb != "icosphere" && !with_uvs) || argc != 5) return bench::usage();
  return bench::write_icosphere(std::stod(argv[2]), std::stoi(argv[3]), with_uvs, argv[4]);
}
