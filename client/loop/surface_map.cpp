#include "client/loop/surface_map.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>

#include "sim/base/input_file.h"

namespace hydroprint::loop {
namespace {

constexpr double kHalfRange_mm = 300, kCell_mm = 4;
constexpr int kColumns = static_cast<int>(2 * kHalfRange_mm / kCell_mm);
constexpr std::size_t kMostPoints = 50'000'000;
/// The columns that are read; others follow them.
const std::string kColumnsRead =
    "property double x\nproperty double y\nproperty double z\n"
    "property double film_x\nproperty double film_y\nproperty double contact_time\n";
constexpr std::size_t kMostDoubles = 64, kMostFlags = 64;

/// The header that the worker writes; only its version, its counts and later columns may vary.
struct Header {
  std::size_t points = 0, triangles = 0;
  std::size_t doubles = 0;        ///< columns of the points
  std::size_t flags_of_face = 0;  ///< bytes after the corners of a triangle
  bool is_good = false;
};

Header read_header(std::istream& file) {
  Header out;
  std::string columns, of_faces;
  bool is_binary = false, has_other_types = false, has_faces = false;
  for (std::string line; std::getline(file, line) && line != "end_header";) {
    std::istringstream words(line);
    std::string first, second;
    words >> first >> second;
    is_binary = is_binary || line == "format binary_little_endian 1.0";
    has_faces = has_faces || second == "face";
    if (first == "element") words >> (has_faces ? out.triangles : out.points);
    if (first != "property") continue;
    if (has_faces && second == "uchar" && !of_faces.empty()) {
      ++out.flags_of_face;
      continue;
    }
    if (has_faces) {
      of_faces += line;
      continue;
    }
    has_other_types = has_other_types || second != "double";
    columns += line + "\n";
    ++out.doubles;
  }
  out.is_good = file && is_binary && !has_other_types && columns.starts_with(kColumnsRead) &&
                out.doubles <= kMostDoubles && out.flags_of_face <= kMostFlags &&
                of_faces == "property list uchar int vertex_indices" && out.points <= kMostPoints &&
                out.triangles <= kMostPoints;
  return out;
}

void read_points(std::istream& file, const Header& header, SurfaceMap& out) {
  double v[kMostDoubles];
  const auto bytes = static_cast<std::streamsize>(header.doubles * sizeof v[0]);
  for (std::size_t i = 0; i < header.points && file.read(reinterpret_cast<char*>(v), bytes); ++i) {
    out.points.emplace_back(v[0], v[1], v[2]);
    out.film_mm.emplace_back(v[3], v[4]);
    out.time_s.push_back(v[5]);
  }
}

void read_triangles(std::istream& file, const Header& header, SurfaceMap& out) {
  std::int32_t corners[3];
  char bytes[1 + sizeof corners + kMostFlags];
  const auto size = static_cast<std::streamsize>(1 + sizeof corners + header.flags_of_face);
  for (std::size_t i = 0; i < header.triangles && file.read(bytes, size); ++i) {
    std::memcpy(corners, bytes + 1, sizeof corners);
    const bool is_good = bytes[0] == 3 && std::all_of(corners, corners + 3, [&](std::int32_t c) {
                           return c >= 0 && static_cast<std::size_t>(c) < out.points.size();
                         });
    if (!is_good) return;
    out.triangles.emplace_back(corners[0], corners[1], corners[2]);
  }
}

/// Returns the barycentric weights at p; nullopt if p lies outside or the triangle is degenerate.
std::optional<Eigen::Vector3d> weights(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                                       const Eigen::Vector2d& c, const Eigen::Vector2d& p) {
  constexpr double kOutside = -1e-9;
  const Eigen::Vector2d u = b - a, v = c - a, w = p - a;
  const double area = u.x() * v.y() - u.y() * v.x();
  if (!(std::abs(area) > 1e-12)) return std::nullopt;
  const double s = (w.x() * v.y() - w.y() * v.x()) / area;
  const double t = (u.x() * w.y() - u.y() * w.x()) / area;
  if (s < kOutside || t < kOutside || s + t > 1 - kOutside) return std::nullopt;
  return Eigen::Vector3d(1 - s - t, s, t);
}

}  // namespace

Result<SurfaceMap> read_surface_map(const std::filesystem::path& path) {
  HP_ASSIGN_OR_RETURN(std::ifstream file, open_input_file(path));
  const Header header = read_header(file);
  SurfaceMap out;
  if (header.is_good) {
    read_points(file, header, out);
    read_triangles(file, header, out);
  }
  if (header.is_good && out.points.size() == header.points &&
      out.triangles.size() == header.triangles) {
    return out;
  }
  return fail(Code::kInvalidArgument,
              path.string() + ": not a complete surface_map.ply; run the simulation again");
}

int FilmLocator::column(double x_mm) const {
  return std::clamp(static_cast<int>((x_mm + kHalfRange_mm) / kCell_mm), 0, kColumns - 1);
}

int FilmLocator::row(double y_mm) const { return column(y_mm); }

FilmLocator::FilmLocator(const SurfaceMap& map)
    : map_(map), cells_(static_cast<std::size_t>(kColumns) * kColumns) {
  for (std::size_t t = 0; t < map.triangles.size(); ++t) {
    const Eigen::Vector3i& corners = map.triangles[t];
    Eigen::Vector2d low = map.film_mm[static_cast<std::size_t>(corners[0])], high = low;
    bool is_reached = true;
    for (const int corner : corners) {
      const Eigen::Vector2d& film = map.film_mm[static_cast<std::size_t>(corner)];
      low = low.cwiseMin(film);
      high = high.cwiseMax(film);
      is_reached = is_reached && film.allFinite();
    }
    if (!is_reached) continue;
    for (int i = column(low.x()); i <= column(high.x()); ++i) {
      for (int j = row(low.y()); j <= row(high.y()); ++j) {
        cells_[static_cast<std::size_t>(j) * kColumns + static_cast<std::size_t>(i)].push_back(
            static_cast<int>(t));
      }
    }
  }
}

std::optional<Eigen::Vector3d> FilmLocator::at(const Eigen::Vector2d& film_mm) const {
  std::optional<Eigen::Vector3d> out;
  double first_s = HUGE_VAL;
  const auto cell = static_cast<std::size_t>(row(film_mm.y())) * kColumns +
                    static_cast<std::size_t>(column(film_mm.x()));
  for (const int t : cells_[cell]) {
    const Eigen::Vector3i& c = map_.triangles[static_cast<std::size_t>(t)];
    const auto a = static_cast<std::size_t>(c[0]), b = static_cast<std::size_t>(c[1]),
               d = static_cast<std::size_t>(c[2]);
    const auto w = weights(map_.film_mm[a], map_.film_mm[b], map_.film_mm[d], film_mm);
    if (!w) continue;
    const double time_s = w->dot(Eigen::Vector3d(map_.time_s[a], map_.time_s[b], map_.time_s[d]));
    if (time_s >= first_s) continue;
    first_s = time_s;
    out = (*w)[0] * map_.points[a] + (*w)[1] * map_.points[b] + (*w)[2] * map_.points[d];
  }
  return out;
}

}  // namespace hydroprint::loop
