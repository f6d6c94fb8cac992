#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hydroprint/v1/spec.pb.h"
#include "proto/rules/check.h"

/// The paint of an object (hydroprint.v1.Paint).
namespace hydroprint::paint {

/// A colour in sRGB, from 0 to 255.
struct Srgb {
  int red = 0, green = 0, blue = 0;
};

/// Reads "#1f4fa8"; nullopt for any other notation.
[[nodiscard]] std::optional<Srgb> parse_colour(std::string_view text);

/// Says what is wrong with the notation of a colour; empty if nothing is.
[[nodiscard]] std::string colour_problem(const std::string& text);

/// Returns the name of a layer for messages: `"eyes"`, or `layer 2` for index 1.
[[nodiscard]] std::string name_of(const v1::PaintLayer& layer, int index);

/// Returns the layer that the short forms of a spec describe: `texture`, `project`,
/// `project_size_mm` and `project_turn_deg`.
template <class Spec>
v1::PaintLayer layer_of(const Spec& spec) {
  v1::PaintLayer layer;
  *layer.mutable_picture() = spec.texture();
  if (spec.has_project()) layer.set_projection(spec.project());
  if (spec.has_project_size_mm()) layer.set_size_mm(spec.project_size_mm());
  if (spec.has_project_turn_deg()) layer.set_turn_deg(spec.project_turn_deg());
  return layer;
}

/// Checks a paint: the rules of its fields, and those between fields, such as directions without
/// length or a depth of a projection that has none.
/// @param path  of the paint in the spec, for the violations: "simulate.paint"; may be empty
[[nodiscard]] std::vector<rules::Violation> check(const v1::Paint& paint, const std::string& path);

/// Checks the paint of a spec and its short forms, which need a texture.
/// @param path  of the message that has them, for the violations: "plan.object"; may be empty
template <class Spec>
std::vector<rules::Violation> check_fields_of(const Spec& spec, const std::string& path);

/// Same as above, for layer_of() a spec without a paint.
/// @param prefix  of the fields' names: "plan.object."
[[nodiscard]] std::vector<rules::Violation> check_short_forms(const v1::PaintLayer& layer,
                                                              const std::string& prefix);

template <class Spec>
std::vector<rules::Violation> check_fields_of(const Spec& spec, const std::string& path) {
  const std::string prefix = path.empty() ? "" : path + ".";
  if (!spec.has_paint()) return check_short_forms(layer_of(spec), prefix);
  if (spec.has_texture() || spec.has_project() || spec.has_project_size_mm() ||
      spec.has_project_turn_deg()) {
    return {{prefix + "texture", "is replaced by paint; leave one of the two out",
             ErrorReason::SPEC_INVALID}};
  }
  return check(spec.paint(), prefix + "paint");
}

}  // namespace hydroprint::paint
