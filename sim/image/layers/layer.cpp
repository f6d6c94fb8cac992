#include "sim/image/layers/layer.h"

#include <array>
#include <utility>

namespace hydroprint::image {
namespace {

constexpr std::array<std::pair<Projection, const char*>, 7> kNames = {{
    {Projection::kUv, "uv"},
    {Projection::kVertexColours, "vertex_colors"},
    {Projection::kPlanar, "planar"},
    {Projection::kDip, "dip"},
    {Projection::kCylindrical, "cylindrical"},
    {Projection::kBox, "box"},
    {Projection::kDecal, "decal"},
}};

}  // namespace

const char* name_of(Projection projection) {
  for (const auto& [known, name] : kNames) {
    if (known == projection) return name;
  }
  return "";
}

std::optional<Projection> projection_of(const std::string& name) {
  for (const auto& [projection, known] : kNames) {
    if (name == known) return projection;
  }
  return std::nullopt;
}

}  // namespace hydroprint::image
