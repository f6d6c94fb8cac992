#include "sim/calibrate/pattern_json.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>

#include "sim/calibrate/base64.h"
#include "sim/scan/lens.h"

namespace hydroprint::calibrate {
namespace {

static_assert(std::endian::native == std::endian::little && sizeof(float) == 4);

constexpr int kLargestPatch_px = 64;
/// Limits, in units of DepthNoise::constant_sigma_mm() (see FixedPattern).
constexpr float kMaxOffset = 100, kMaxShared = 100;

template <class T>
std::string text_of(const T* values, std::size_t count) {
  std::vector<unsigned char> bytes(count * sizeof(T));
  if (count > 0) std::memcpy(bytes.data(), values, bytes.size());
  return base64(bytes);
}

/// Returns the values in a base64 text; empty if it is malformed.
template <class T>
std::vector<T> values_of(const nlohmann::json& text) {
  const auto bytes = from_base64(text.get_ref<const std::string&>());
  if (!bytes || bytes->size() % sizeof(T) != 0) return {};
  std::vector<T> out(bytes->size() / sizeof(T));
  if (!out.empty()) std::memcpy(out.data(), bytes->data(), bytes->size());
  return out;
}

/// Returns whether all values are between `least` and `most`.
bool are_within(const std::vector<float>& values, float least, float most) {
  return std::all_of(values.begin(), values.end(),
                     [&](float x) { return x >= least && x <= most; });
}

}  // namespace

nlohmann::ordered_json pattern_json(const scan::FixedPattern& pattern) {
  return {
      {"patch_px", pattern.patch_px},
      {"offset", text_of(pattern.offset.data(), pattern.offset.size())},
      {"sigma", text_of(pattern.sigma.data(), pattern.sigma.size())},
      {"shared_step", text_of(pattern.step.data(), static_cast<std::size_t>(pattern.step.size()))},
      {"shared", text_of(pattern.shared.data(), static_cast<std::size_t>(pattern.shared.size()))}};
}

std::optional<scan::FixedPattern> pattern_of(const nlohmann::json& json, int width_px,
                                             int height_px) {
  scan::FixedPattern out{width_px, height_px, json.at("patch_px").get<int>()};
  if (out.patch_px < 1 || out.patch_px > kLargestPatch_px) return {};
  out.offset = values_of<float>(json.at("offset"));
  out.sigma = values_of<float>(json.at("sigma"));
  const auto step = values_of<float>(json.at("shared_step"));
  const auto shared = values_of<std::int8_t>(json.at("shared"));
  if (out.offset.size() != out.patches() || out.sigma.size() != out.patches() ||
      shared.size() != step.size() * out.patches() || step.size() < scan::Lens::kParameters)
    return {};
  if (!are_within(out.offset, -kMaxOffset, kMaxOffset) || !are_within(out.sigma, 0, kMaxOffset) ||
      !are_within(step, 0, kMaxShared))
    return {};
  const auto unknowns = static_cast<Eigen::Index>(step.size());
  out.step = Eigen::Map<const Eigen::VectorXf>(step.data(), unknowns);
  out.shared = Eigen::Map<const decltype(out.shared)>(shared.data(), unknowns,
                                                      static_cast<Eigen::Index>(out.patches()));
  return out;
}

}  // namespace hydroprint::calibrate
