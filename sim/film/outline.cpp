#include "sim/film/outline.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>

#include "sim/base/checked_json.h"

namespace hydroprint::film {
namespace {

using Eigen::Vector2d;

constexpr double kMinSize_mm = 10;
constexpr double kMaxSize_mm = 2000;
constexpr double kMaxChord_mm = 3;
constexpr std::size_t kMaxCorners = 10000;
constexpr double kOnEdge_mm = 1e-9;

struct Sheet {
  std::string_view name;
  Vector2d size_mm;
};
constexpr std::string_view kCircle = "circle:";
constexpr std::string_view kPolygon = "polygon:";
const std::array<Sheet, 3> kSheets = {
    {{"a4", {210, 297}}, {"a3", {297, 420}}, {"letter", {215.9, 279.4}}}};

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

std::optional<double> number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

tl::unexpected<Error> not_understood(const std::string& text) {
  return fail(
      Code::kInvalidArgument,
      "film '" + text +
          "' is not a known size or shape. Use A4, A3, letter, WIDTHxHEIGHT, circle:RADIUS (mm) or "
          "polygon:FILE.json");
}

Status check_size(const std::string& what, const Vector2d& size_mm) {
  for (const double side_mm : {size_mm.x(), size_mm.y()}) {
    if (!(side_mm >= kMinSize_mm && side_mm <= kMaxSize_mm)) {
      return fail(Code::kOutOfRange,
                  fmt::format("{}: {} x {} mm is out of range. Use sides from {} to {} mm", what,
                              size_mm.x(), size_mm.y(), kMinSize_mm, kMaxSize_mm));
    }
  }
  return {};
}

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

double area_mm2(const std::vector<Vector2d>& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    twice += cross(polygon[i] - polygon[0], polygon[(i + 1) % polygon.size()] - polygon[0]);
  }
  return twice / 2;
}

Outline rectangle(const std::string& name, const Vector2d& size_mm) {
  const Vector2d h = size_mm / 2;
  return {{-h, {h.x(), -h.y()}, h, {-h.x(), h.y()}}, -h, h, name};
}

Outline circle(const std::string& name, double radius_mm) {
  // Uses a multiple of four corners, the first on the x axis, so that the polygon is symmetric
  // about both axes.
  int corners = 4 * static_cast<int>(std::ceil(std::numbers::pi * radius_mm / (2 * kMaxChord_mm)));
  const auto corner_radius_mm = [&] {
    const double sector_rad = 2 * std::numbers::pi / corners;
    return radius_mm * std::sqrt(sector_rad / std::sin(sector_rad));
  };
  while (2 * corner_radius_mm() * std::sin(std::numbers::pi / corners) > kMaxChord_mm) corners += 4;

  Outline out;
  out.name = name;
  for (int i = 0; i < corners; ++i) {
    const double angle_rad = 2 * std::numbers::pi * i / corners;
    out.polygon.push_back(corner_radius_mm() * Vector2d(std::cos(angle_rad), std::sin(angle_rad)));
  }
  out.max_mm = Vector2d::Constant(radius_mm);
  out.min_mm = -out.max_mm;
  return out;
}

bool on_segment(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  const Vector2d along = b - a;
  const double share = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (p - a - share * along).norm() <= kOnEdge_mm;
}

/// Returns true if the closed segments ab and cd have a point in common.
bool meet(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  const double c_side = cross(b - a, c - a);
  const double d_side = cross(b - a, d - a);
  const double a_side = cross(d - c, a - c);
  const double b_side = cross(d - c, b - c);
  if (((c_side > 0) != (d_side > 0)) && ((a_side > 0) != (b_side > 0)) && c_side != 0 &&
      d_side != 0 && a_side != 0 && b_side != 0) {
    return true;
  }
  return on_segment(c, a, b) || on_segment(d, a, b) || on_segment(a, c, d) || on_segment(b, c, d);
}

/// Returns two edges (by their first corners) that cross, touch or fold back on each other; nullopt
/// if there are none.
std::optional<std::pair<std::size_t, std::size_t>> crossing(const std::vector<Vector2d>& polygon) {
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vector2d& a = polygon[i];
    const Vector2d& b = polygon[(i + 1) % n];
    const Vector2d& next = polygon[(i + 2) % n];
    if (on_segment(next, a, b) || on_segment(a, b, next)) return {{i, (i + 1) % n}};
    for (std::size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;  // the last edge and the first are neighbours
      const Vector2d& c = polygon[j];
      const Vector2d& d = polygon[(j + 1) % n];
      if (std::max(a.x(), b.x()) < std::min(c.x(), d.x()) - kOnEdge_mm ||
          std::max(c.x(), d.x()) < std::min(a.x(), b.x()) - kOnEdge_mm) {
        continue;
      }
      if (meet(a, b, c, d)) return {{i, j}};
    }
  }
  return std::nullopt;
}

Result<std::vector<Vector2d>> read_corners(const std::string& file) {
  HP_ASSIGN_OR_RETURN(const nlohmann::json json, read_json_file(file));
  if (!json.is_array()) {
    return fail(Code::kInvalidArgument,
                file + ": not a list of corners. Write [[x, y], [x, y], ...] in mm");
  }
  if (json.size() > kMaxCorners) {
    return fail(Code::kOutOfRange, fmt::format("{}: {} corners are too many. Use at most {}", file,
                                               json.size(), kMaxCorners));
  }
  std::vector<Vector2d> corners;
  for (const auto& corner : json) {
    if (!corner.is_array() || corner.size() != 2 || !corner[0].is_number() ||
        !corner[1].is_number()) {
      return fail(Code::kInvalidArgument,
                  fmt::format("{}: corner {}: not a pair of numbers. Write [x, y] in mm", file,
                              corners.size() + 1));
    }
    corners.emplace_back(corner[0].get<double>(), corner[1].get<double>());
  }
  // Many programs close a polygon by repeating its first corner.
  if (corners.size() > 3 && corners.front() == corners.back()) corners.pop_back();
  return corners;
}

Result<Outline> read_polygon(const std::string& name, const std::string& file) {
  Outline out;
  out.name = name;
  HP_ASSIGN_OR_RETURN(out.polygon, read_corners(file));
  if (out.polygon.size() < 3) {
    return fail(
        Code::kInvalidArgument,
        fmt::format("{}: {} corners are too few. Give at least three", file, out.polygon.size()));
  }
  out.min_mm = out.max_mm = out.polygon[0];
  for (const Vector2d& corner : out.polygon) {
    out.min_mm = out.min_mm.cwiseMin(corner);
    out.max_mm = out.max_mm.cwiseMax(corner);
  }
  HP_RETURN_IF_ERROR(check_size(file, out.size_mm()));
  for (std::size_t i = 0; i < out.polygon.size(); ++i) {
    const std::size_t next = (i + 1) % out.polygon.size();
    if ((out.polygon[i] - out.polygon[next]).norm() <= kOnEdge_mm) {
      return fail(Code::kInvalidArgument,
                  fmt::format("{}: corners {} and {} are the same. Remove one of them", file, i + 1,
                              next + 1));
    }
  }
  if (const auto edges = crossing(out.polygon)) {
    return fail(Code::kInvalidArgument,
                fmt::format("{}: the edges after corners {} and {} meet. Give a polygon that does "
                            "not cross or touch itself",
                            file, edges->first + 1, edges->second + 1));
  }
  if (area_mm2(out.polygon) < 0) std::reverse(out.polygon.begin(), out.polygon.end());
  return out;
}

Result<Outline> parse_circle(const std::string& text, std::string_view radius) {
  const std::optional<double> radius_mm = number(radius);
  if (!radius_mm) return not_understood(text);
  HP_RETURN_IF_ERROR(check_size("film '" + text + "'", Vector2d::Constant(2 * *radius_mm)));
  return circle(text, *radius_mm);
}

Result<Outline> parse_rectangle(const std::string& text) {
  const std::size_t x = text.find_first_of("xX");
  if (x == std::string::npos) return not_understood(text);
  const std::optional<double> width_mm = number(std::string_view(text).substr(0, x));
  const std::optional<double> height_mm = number(std::string_view(text).substr(x + 1));
  if (!width_mm || !height_mm) return not_understood(text);
  const Vector2d size_mm(*width_mm, *height_mm);
  HP_RETURN_IF_ERROR(check_size("film '" + text + "'", size_mm));
  return rectangle(text, size_mm);
}

}  // namespace

Result<Outline> parse_outline(const std::string& text) {
  for (const Sheet& sheet : kSheets) {
    if (lower(text) == sheet.name) return rectangle(text, sheet.size_mm);
  }
  if (text.starts_with(kCircle)) {
    return parse_circle(text, std::string_view(text).substr(kCircle.size()));
  }
  if (const auto file = polygon_file(text)) return read_polygon(text, file->string());
  return parse_rectangle(text);
}

std::optional<std::filesystem::path> polygon_file(const std::string& text) {
  if (!text.starts_with(kPolygon)) return std::nullopt;
  return text.substr(kPolygon.size());
}

bool contains(const Outline& outline, const Eigen::Vector2d& point_mm) {
  const auto& polygon = outline.polygon;
  bool inside = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& a = polygon[i];
    const Vector2d& b = polygon[(i + 1) % polygon.size()];
    if (on_segment(point_mm, a, b)) return true;
    // The interval in y is half-open, so that a ray through a corner crosses once.
    if ((a.y() > point_mm.y()) != (b.y() > point_mm.y()) &&
        (cross(b - a, point_mm - a) > 0) == (b.y() > a.y())) {
      inside = !inside;
    }
  }
  return inside;
}

}  // namespace hydroprint::film
