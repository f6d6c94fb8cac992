#include "sim/worker/common/surface_ply.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "sim/base/artifact_file.h"
#include "sim/base/check.h"
#include "sim/base/input_file.h"

namespace hydroprint::worker {
namespace {

static_assert(std::endian::native == std::endian::little, "the files are little-endian");

constexpr std::string_view kHeaderEnd = "end_header\n";
constexpr std::size_t kLongestHeader = 10'000;
constexpr std::size_t kMostElements = std::size_t{1} << 31;  // of each kind in a file

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
/// @param of_faces    likewise, after the faces' corners
std::string header(std::size_t points, std::size_t triangles, const std::string& properties,
                   const std::string& of_faces = {}) {
  return fmt::format(R"(ply
format binary_little_endian 1.0
comment hydroprint {}
element vertex {}
property double x
property double y
property double z
{}element face {}
property list uchar int vertex_indices
{}end_header
)",
                     HYDROPRINT_VERSION, points, properties, triangles, of_faces);
}

/// @param flags  per triangle; empty: the header has no property for them
Status write(const std::filesystem::path& path, const std::vector<Eigen::Vector3i>& triangles,
             std::string bytes, const std::vector<std::uint8_t>& flags = {}) {
  HP_CHECK(flags.empty() || flags.size() == triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    put(bytes, std::uint8_t{3});
    for (const int corner : triangles[t]) put(bytes, static_cast<std::int32_t>(corner));
    if (!flags.empty()) put(bytes, flags[t]);
  }
  return image::write_artifact(
      path, std::span(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
}

/// Returns a header without the line that names the version.
std::string without_version(std::string_view header) {
  std::string out(header);
  const std::size_t begin = out.find("comment hydroprint ");
  if (begin == std::string::npos) return out;
  return out.erase(begin, out.find('\n', begin) - begin + 1);
}

/// Properties of the vertices of a plan with this number of dips.
std::string plan_properties(std::size_t dips) {
  std::string out = "property int dip\n";
  for (const char* name : {"weight", "stretch", "stretch_min"}) {
    for (std::size_t k = 1; k <= dips; ++k) out += fmt::format("property double {}_{}\n", name, k);
  }
  return out;
}

/// Takes values from bytes. The caller knows how many there are.
class Bytes {
 public:
  explicit Bytes(std::string_view bytes) : rest_(bytes) {}

  template <class Value>
  Value take() {
    Value out{};
    std::memcpy(&out, rest_.data(), sizeof out);
    rest_.remove_prefix(sizeof out);
    return out;
  }
  Eigen::Vector3d take_point() {
    Eigen::Vector3d out;
    for (double& coordinate : out) coordinate = take<double>();
    return out;
  }

 private:
  std::string_view rest_;
};

/// Returns the number in the first line "PREFIX NUMBER" of a header; nullopt if there is none.
std::optional<std::size_t> count_of(std::string_view header, std::string_view prefix) {
  const std::size_t at = header.find(prefix);
  if (at == std::string_view::npos) return std::nullopt;
  std::size_t out = 0;
  const char* const begin = header.data() + at + prefix.size();
  const auto [end, error] = std::from_chars(begin, header.data() + header.size(), out);
  if (error != std::errc() || *end != '\n' || out > kMostElements) return std::nullopt;
  return out;
}

Result<std::string> read_bytes(const std::filesystem::path& path) {
  HP_ASSIGN_OR_RETURN(std::ifstream file, open_input_file(path));
  std::string out;
  std::array<char, 1 << 16> chunk{};
  while (file.read(chunk.data(), chunk.size()) || file.gcount() > 0)
    out.append(chunk.data(), static_cast<std::size_t>(file.gcount()));
  return out;
}

/// Returns whether every number of a plan can be used.
bool is_usable(const PlanSurface& plan) {
  const auto count = static_cast<int>(plan.points.size());
  const auto is_finite = [](const Eigen::Vector3d& p) { return p.allFinite(); };
  const auto is_inside = [count](const Eigen::Vector3i& t) {
    return t.minCoeff() >= 0 && t.maxCoeff() < count;
  };
  const auto is_stretch = [](double s) { return std::isnan(s) || s >= 0; };
  return std::ranges::all_of(plan.points, is_finite) &&
         std::ranges::all_of(plan.triangles, is_inside) &&
         std::ranges::all_of(plan.stretch, [&](const std::vector<double>& of_dip) {
           return std::ranges::all_of(of_dip, is_stretch);
         });
}

}  // namespace

Status write_surface_map(const std::filesystem::path& path, const mesh::Surface& surface,
                         const flow::SurfaceMap& map, const std::vector<std::uint8_t>& face_flags) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::string bytes = header(surface.points.size(), surface.triangles.size(),
                             "property double film_x\nproperty double film_y\n"
                             "property double contact_time\nproperty double stretch\n"
                             "property double stretch_min\nproperty double error_mm\n",
                             "property uchar flags\n");
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    put(bytes, surface.points[i]);
    const bool reached = map.film_mm[i].allFinite();
    put(bytes, reached ? map.film_mm[i].x() : kNone);
    put(bytes, reached ? map.film_mm[i].y() : kNone);
    put(bytes, reached ? map.contact_time_s[i] : kNone);
    put(bytes, reached ? map.stretch[i] : kNone);
    put(bytes, reached ? map.least_stretch[i] : kNone);
    put(bytes, reached && !map.error_mm.empty() ? map.error_mm[i] : kNone);
  }
  return write(path, surface.triangles, std::move(bytes), face_flags);
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
  std::string bytes =
      header(surface.points.size(), surface.triangles.size(), plan_properties(plan.dips.size()));
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    put(bytes, surface.points[i]);
    put(bytes, static_cast<std::int32_t>(plan.dip_at[i]));
    for (const auto& weights : plan.weights_at) put(bytes, weights[i]);
    for (const auto& one : plan.dips) put(bytes, one.map.stretch[i]);
    for (const auto& one : plan.dips) put(bytes, one.map.least_stretch[i]);
  }
  return write(path, surface.triangles, std::move(bytes));
}

Result<PlanSurface> read_plan_surface(const std::filesystem::path& path, std::size_t dips) {
  HP_ASSIGN_OR_RETURN(const std::string file, read_bytes(path));
  const auto refused = [&] {
    return fail(Code::kInvalidArgument,
                fmt::format("{}: not the plan.ply of a plan with {} dip{}. Make the plan again",
                            path.string(), dips, dips == 1 ? "" : "s"));
  };
  const std::size_t end = std::min(file.find(kHeaderEnd), kLongestHeader);
  const std::string_view top =
      std::string_view(file).substr(0, std::min(file.size(), end + kHeaderEnd.size()));
  const auto points = count_of(top, "\nelement vertex ");
  const auto triangles = count_of(top, "\nelement face ");
  if (!points || !triangles) return refused();
  std::string expected = header(*points, *triangles, plan_properties(dips));
  if (without_version(top) != without_version(expected)) return refused();
  const std::size_t per_point =
      3 * sizeof(double) + sizeof(std::int32_t) + 3 * dips * sizeof(double);
  constexpr std::size_t kPerTriangle = 1 + 3 * sizeof(std::int32_t);
  if (file.size() != top.size() + *points * per_point + *triangles * kPerTriangle) return refused();

  PlanSurface out;
  out.stretch.resize(dips);
  Bytes bytes(std::string_view(file).substr(top.size()));
  for (std::size_t i = 0; i < *points; ++i) {
    out.points.push_back(bytes.take_point());
    bytes.take<std::int32_t>();
    for (std::size_t k = 0; k < dips; ++k) bytes.take<double>();
    for (auto& of_dip : out.stretch) of_dip.push_back(bytes.take<double>());
    for (std::size_t k = 0; k < dips; ++k) bytes.take<double>();
  }
  for (std::size_t i = 0; i < *triangles; ++i) {
    if (bytes.take<std::uint8_t>() != 3) return refused();
    const int a = bytes.take<std::int32_t>(), b = bytes.take<std::int32_t>();
    out.triangles.emplace_back(a, b, bytes.take<std::int32_t>());
  }
  if (!is_usable(out)) return refused();
  return out;
}

Status write_scan(const std::filesystem::path& path, const scan::TriangleMesh& mesh) {
  std::string bytes = header(mesh.points_mm.size(), mesh.triangles.size(), "");
  for (const Eigen::Vector3d& point : mesh.points_mm) put(bytes, point);
  return write(path, mesh.triangles, std::move(bytes));
}

}  // namespace hydroprint::worker
