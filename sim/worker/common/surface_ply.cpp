#include "sim/worker/common/surface_ply.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string>

#include "sim/base/artifact_file.h"

namespace hydroprint::worker {
namespace {

static_assert(std::endian::native == std::endian::little, "the files are little-endian");

template <class Value>
void put(std::string& bytes, Value value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void put(std::string& bytes, const Eigen::Vector3d& point) {
  for (const double coordinate : point) put(bytes, coordinate);
}

std::uint8_t byte(float channel) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(channel, 0.0f, 1.0f)));
}

/// @param properties  lines of the header, after x, y, z
std::string header(std::size_t points, std::size_t triangles, const std::string& properties) {
  return fmt::format(R"(ply
format binary_little_endian 1.0
comment hydroprint {}
element vertex {}
property double x
property double y
property double z
{}element face {}
property list uchar int vertex_indices
end_header
)",
                     HYDROPRINT_VERSION, points, properties, triangles);
}

Status write(const std::filesystem::path& path, const std::vector<Eigen::Vector3i>& triangles,
             std::string bytes) {
  for (const Eigen::Vector3i& triangle : triangles) {
    put(bytes, std::uint8_t{3});
    for (const int corner : triangle) put(bytes, static_cast<std::int32_t>(corner));
  }
  return image::write_artifact(
      path, std::span(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
}

}  // namespace

Status write_surface_map(const std::filesystem::path& path, const mesh::Surface& surface,
                         const flow::SurfaceMap& map) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::string bytes = header(surface.points.size(), surface.triangles.size(),
                             "property double film_x\nproperty double film_y\n"
                             "property double contact_time\nproperty double stretch\n");
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    put(bytes, surface.points[i]);
    const bool reached = map.film_mm[i].allFinite();
    put(bytes, reached ? map.film_mm[i].x() : kNone);
    put(bytes, reached ? map.film_mm[i].y() : kNone);
    put(bytes, reached ? map.contact_time_s[i] : kNone);
    put(bytes, reached ? map.stretch[i] : kNone);
  }
  return write(path, surface.triangles, std::move(bytes));
}

Status write_landed(const std::filesystem::path& path, const mesh::Surface& surface,
                    const std::vector<Eigen::Vector3f>& colours) {
  std::string bytes = header(surface.points.size(), surface.triangles.size(),
                             "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                             "property uchar landed\n");
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    put(bytes, surface.points[i]);
    const bool landed = colours[i].allFinite();
    for (const float channel : colours[i]) put(bytes, landed ? byte(channel) : std::uint8_t{255});
    put(bytes, static_cast<std::uint8_t>(landed ? 1 : 0));
  }
  return write(path, surface.triangles, std::move(bytes));
}

Status write_plan(const std::filesystem::path& path, const pipeline::Plan& plan) {
  const mesh::Surface& surface = plan.surface;
  const std::size_t dips = plan.dips.size();
  std::string properties = "property int dip\n";
  for (const char* name : {"weight", "stretch"}) {
    for (std::size_t k = 1; k <= dips; ++k)
      properties += fmt::format("property double {}_{}\n", name, k);
  }
  std::string bytes = header(surface.points.size(), surface.triangles.size(), properties);
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    put(bytes, surface.points[i]);
    put(bytes, static_cast<std::int32_t>(plan.dip_at[i]));
    for (const auto& weights : plan.weights_at) put(bytes, weights[i]);
    for (const auto& one : plan.dips) put(bytes, one.map.stretch[i]);
  }
  return write(path, surface.triangles, std::move(bytes));
}

Status write_scan(const std::filesystem::path& path, const scan::TriangleMesh& mesh) {
  std::string bytes = header(mesh.points_mm.size(), mesh.triangles.size(), "");
  for (const Eigen::Vector3d& point : mesh.points_mm) put(bytes, point);
  return write(path, mesh.triangles, std::move(bytes));
}

}  // namespace hydroprint::worker
