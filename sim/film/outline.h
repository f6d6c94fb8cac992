#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sim/base/result.h"

namespace hydroprint::film {

/// The film's edge, clamped to the vat (Gamma_v of section 4.1): a simple polygon in F, mm,
/// counter-clockwise. The film image covers the bounding box of the outline, which is centred on
/// the origin unless the outline was given as a polygon.
struct Outline {
  std::vector<Eigen::Vector2d> polygon;
  Eigen::Vector2d min_mm = Eigen::Vector2d::Zero();
  Eigen::Vector2d max_mm = Eigen::Vector2d::Zero();
  std::string name;  ///< as entered by the user

  [[nodiscard]] Eigen::Vector2d size_mm() const { return max_mm - min_mm; }
};

/// Parses "A4", "A3", "letter", "WxH", "circle:RADIUS" or "polygon:FILE.json". A circle becomes a
/// polygon of the same area with chords of at most 3 mm. Errors: kOutOfRange for sizes below 10 mm
/// or above 2000 mm; kInvalidArgument for malformed text and for polygons that intersect themselves
/// or have fewer than three corners.
[[nodiscard]] Result<Outline> parse_outline(const std::string& text);

/// Returns the file in a text for parse_outline ("polygon:FILE.json"); nullopt for the other
/// formats.
[[nodiscard]] std::optional<std::filesystem::path> polygon_file(const std::string& text);

/// Returns true if the point lies inside the outline or on it.
[[nodiscard]] bool contains(const Outline& outline, const Eigen::Vector2d& point_mm);

}  // namespace hydroprint::film
