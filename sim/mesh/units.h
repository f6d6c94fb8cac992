#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace hydroprint::mesh {

/// A length unit of model files.
struct Unit {
  std::string_view name;  ///< plural: "inches"
  double mm = 1;
};

/// Returns true if an object with this longest side is probably in another unit: below 5 mm, or
/// above 1,000 mm.
[[nodiscard]] bool is_odd_size(double longest_mm);

/// Returns the likely unit of a file: for glTF the metre, which its specification says, if the
/// object then has a possible size; else the one in which it comes nearest to 150 mm, a usual size.
/// @param longest    longest side in units of the file
/// @param extension  of the file's name: ".glb"
/// @return nullopt if the object has a possible size in no unit
[[nodiscard]] std::optional<Unit> likely_unit(double longest, const std::string& extension);

}  // namespace hydroprint::mesh
