#include "sim/worker/common/paint.h"

#include <filesystem>
#include <numbers>
#include <optional>

#include "hydroprint/v1/report.pb.h"
#include "sim/worker/common/report_values.h"

namespace hydroprint::worker {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180;

Eigen::Vector3f colour_of(const std::string& text) {
  const paint::Srgb colour = paint::parse_colour(text).value_or(paint::Srgb{});
  return Eigen::Vector3i(colour.red, colour.green, colour.blue).cast<float>() / 255;
}

std::optional<Eigen::Vector3d> vector_of(const google::protobuf::RepeatedField<double>& numbers) {
  if (numbers.size() != 3) return std::nullopt;
  return Eigen::Vector3d(numbers[0], numbers[1], numbers[2]);
}

image::Layer layer_of(const v1::PaintLayer& layer, int index, const InputFolder& inputs) {
  image::Layer out;
  out.picture = inputs.path(layer.picture());
  out.name = paint::name_of(layer, index);
  if (layer.has_colour()) out.colour = colour_of(layer.colour());
  if (layer.has_projection()) out.projection = image::projection_of(layer.projection());
  out.position_mm = vector_of(layer.position_mm());
  out.direction = vector_of(layer.direction());
  out.up = vector_of(layer.up());
  if (layer.has_size_mm()) out.size_mm = layer.size_mm();
  if (layer.has_depth_mm()) out.depth_mm = layer.depth_mm();
  out.turn_rad = layer.turn_deg() * kRadPerDeg;
  out.mirror = layer.mirror();
  if (layer.has_repeat()) out.repeat = layer.repeat();
  if (layer.has_opacity()) out.opacity = layer.opacity();
  if (layer.has_blend_mm()) out.blend_mm = layer.blend_mm();
  return out;
}

bool has_place(image::Projection projection) {
  return projection != image::Projection::kUv && projection != image::Projection::kVertexColours;
}

}  // namespace

image::PaintSource paint_source_of(const v1::Paint& paint, const InputFolder& inputs) {
  image::PaintSource out;
  if (paint.has_base_colour()) out.base_colour = colour_of(paint.base_colour());
  for (int i = 0; i < paint.layers_size(); ++i)
    out.layers.push_back(layer_of(paint.layers(i), i, inputs));
  return out;
}

void add_layers(const std::vector<image::PlacedLayer>& layers, v1::SimulateReport& out) {
  for (const image::PlacedLayer& layer : layers) {
    v1::SimulateReport::Layer& added = *out.add_layers();
    added.set_name(layer.name);
    added.set_projection(std::string(image::name_of(layer.projection)));
    added.set_opacity(layer.opacity);
    if (!has_place(layer.projection)) continue;
    const image::Placement& place = layer.placement;
    add_all(place.position_mm, added.mutable_position_mm());
    add_all(place.axes.col(2), added.mutable_direction());
    add_all(place.axes.col(1), added.mutable_up());
    added.set_size_mm(place.width_mm);
    added.set_turn_deg(place.turn_rad / kRadPerDeg);
    added.set_mirror(place.mirror);
    added.set_repeat(place.repeat);
  }
}

}  // namespace hydroprint::worker
