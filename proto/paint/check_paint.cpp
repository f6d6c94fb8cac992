#include "proto/paint/check_paint.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>
#include <utility>

namespace hydroprint::paint {
namespace {

using Numbers = google::protobuf::RepeatedField<double>;
using Vector = std::array<double, 3>;

constexpr ErrorReason kReason = ErrorReason::SPEC_INVALID;
/// Sine of the smallest angle between direction and up: one degree.
constexpr double kLeastSine = 0.0174524;

Vector vector_of(const Numbers& numbers) { return {numbers[0], numbers[1], numbers[2]}; }

double length(const Vector& v) { return std::hypot(v[0], v[1], v[2]); }

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A group of options, and the projections that have them.
struct Option {
  bool is_set = false;
  std::string field;
  std::vector<std::string> projections;
};

std::string listed(const std::vector<std::string>& names) {
  std::string out;
  for (std::size_t i = 0; i < names.size(); ++i)
    out += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return out;
}

std::vector<Option> options_of(const v1::PaintLayer& layer) {
  const std::vector<std::string> placed = {"planar", "dip", "cylindrical", "box", "decal"};
  const std::vector<std::string> directed = {"planar", "cylindrical", "box", "decal"};
  return {
      {!layer.position_mm().empty(), "position_mm", placed},
      {!layer.direction().empty(), "direction", directed},
      {!layer.up().empty(), "up", placed},
      {layer.has_size_mm(), "size_mm", placed},
      {layer.has_depth_mm(), "depth_mm", {"decal"}},
      {layer.has_turn_deg(), "turn_deg", placed},
      {layer.mirror(), "mirror", placed},
      {layer.has_repeat(), "repeat", {"uv", "planar", "dip", "cylindrical", "box"}},
      {layer.has_blend_mm(), "blend_mm", {"box"}},
  };
}

class LayerCheck {
 public:
  LayerCheck(const v1::PaintLayer& layer, std::string path)
      : layer_(layer), path_(std::move(path)) {}

  std::vector<rules::Violation> run() {
    check_colour();
    check_options();
    check_vectors();
    return std::move(violations_);
  }

 private:
  void add(const std::string& field, std::string problem) {
    violations_.push_back({path_ + "." + field, std::move(problem), kReason});
  }

  void check_colour() {
    if (layer_.has_colour()) {
      if (std::string problem = colour_problem(layer_.colour()); !problem.empty())
        add("colour", std::move(problem));
      if (layer_.has_picture()) add("colour", "is replaced by picture; leave one of the two out");
    }
    const std::string& projection = layer_.projection();
    const bool has_own = projection == "uv" || projection == "vertex_colors";
    if (!has_own && !layer_.has_picture() && !layer_.has_colour())
      add("picture", "is missing; name a picture, or give a colour");
    if (projection == "vertex_colors" && (layer_.has_picture() || layer_.has_colour()))
      add("projection", "vertex_colors has no picture and no colour; leave them out");
  }

  void check_options() {
    if (!layer_.has_projection()) return;
    for (const Option& option : options_of(layer_)) {
      const auto& names = option.projections;
      if (!option.is_set || std::ranges::find(names, layer_.projection()) != names.end()) continue;
      add(option.field, "does not apply to " + layer_.projection() + ", only to " + listed(names) +
                            "; leave it out, or choose another projection");
    }
  }

  void check_vectors() {
    const bool has_direction = layer_.direction_size() == 3, has_up = layer_.up_size() == 3;
    if (has_direction && !(length(vector_of(layer_.direction())) > 1e-9))
      add("direction", "has no length; give a direction such as [0, 1, 0]");
    if (has_up && !(length(vector_of(layer_.up())) > 1e-9))
      add("up", "has no length; give a direction such as [0, 0, 1]");
    if (!violations_.empty() || !has_up) return;
    const Vector up = vector_of(layer_.up()), direction = direction_or_default();
    if (length(cross(up, direction)) <= kLeastSine * length(up) * length(direction))
      add("up", "is parallel to the direction of view; choose another one");
  }

  [[nodiscard]] Vector direction_or_default() const {
    if (layer_.direction_size() == 3) return vector_of(layer_.direction());
    const std::string& projection = layer_.projection();
    return projection == "cylindrical" || projection == "box" ? Vector{0, 1, 0} : Vector{0, 0, 1};
  }

  const v1::PaintLayer& layer_;
  std::string path_;
  std::vector<rules::Violation> violations_;
};

}  // namespace

std::optional<Srgb> parse_colour(std::string_view text) {
  if (text.size() != 7 || text[0] != '#') return std::nullopt;
  std::array<int, 3> parts{};
  for (std::size_t i = 0; i < 3; ++i) {
    const char* const begin = text.data() + 1 + 2 * i;
    const auto [end, error] = std::from_chars(begin, begin + 2, parts[i], 16);
    if (error != std::errc() || end != begin + 2 || *begin == '-') return std::nullopt;
  }
  return Srgb{parts[0], parts[1], parts[2]};
}

std::string colour_problem(const std::string& text) {
  return parse_colour(text) ? "" : "must be \"#\" and six hexadecimal digits, such as \"#1f4fa8\"";
}

std::string name_of(const v1::PaintLayer& layer, int index) {
  if (!layer.name().empty()) return "\"" + layer.name() + "\"";
  const std::string& file = layer.picture().name();
  if (!file.empty()) return "\"" + file.substr(file.rfind('/') + 1) + "\"";
  return "layer " + std::to_string(index + 1);
}

std::vector<rules::Violation> check(const v1::Paint& paint, const std::string& path) {
  const rules::FormatChecks formats = {{"colour", colour_problem}};
  auto violations = rules::check(paint, formats, path);
  if (!violations.empty()) return violations;
  const std::string prefix = path.empty() ? "" : path + ".";
  for (int i = 0; i < paint.layers_size(); ++i) {
    auto more = LayerCheck(paint.layers(i), prefix + "layers[" + std::to_string(i) + "]").run();
    violations.insert(violations.end(), more.begin(), more.end());
  }
  return violations;
}

std::vector<rules::Violation> check_short_forms(const v1::PaintLayer& layer,
                                                const std::string& prefix) {
  const bool projects = layer.has_projection() || layer.has_size_mm() || layer.has_turn_deg();
  if (!projects) return {};
  if (layer.picture().name().empty())
    return {{prefix + "project", "needs a picture; name it in texture", kReason}};
  auto violations = rules::check(layer, {}, "layer");
  if (violations.empty()) violations = LayerCheck(layer, "layer").run();
  const std::string start = "layer.";
  for (rules::Violation& violation : violations) {
    const std::string field = violation.field.substr(start.size());
    violation.field = prefix + (field == "projection" ? "project" : "project_" + field);
  }
  return violations;
}

}  // namespace hydroprint::paint
