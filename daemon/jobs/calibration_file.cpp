#include "daemon/jobs/calibration_file.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "hydroprint/v1/calibration_service.pb.h"

namespace hydroprint::daemon {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMostEntries = 100;
constexpr std::size_t kLongestText = 1000;
constexpr double kFarthest_mm = 1e5;

/// Reads values from a worker's file and keeps the first error.
class Reader {
 public:
  explicit Reader(const Json& json) : json_(json) {}

  double number(const std::string& pointer, double most = kFarthest_mm) {
    const Json* found = find(pointer);
    if (found != nullptr && found->is_number() && std::abs(found->get<double>()) <= most) {
      return found->get<double>();
    }
    refuse(pointer);
    return 0;
  }
  void numbers(const std::string& pointer, std::size_t count,
               google::protobuf::RepeatedField<double>& out, double most = kFarthest_mm) {
    for (std::size_t i = 0; i < count; ++i) {
      out.Add(number(fmt::format("{}/{}", pointer, i), most));
    }
  }
  /// Reads a text. Truncates it if it is too long, and replaces unprintable characters by '?'.
  std::string text(const std::string& pointer) {
    const Json* found = find(pointer);
    if (found == nullptr || !found->is_string()) {
      refuse(pointer);
      return {};
    }
    const auto all = found->get<std::string>();
    std::string out;
    for (const unsigned char c : all.substr(0, kLongestText)) {
      out += c >= ' ' && c < 0x7f ? static_cast<char>(c) : '?';
    }
    return out;
  }
  std::size_t size(const std::string& pointer) {
    const Json* found = find(pointer);
    if (found != nullptr && found->is_array() && found->size() <= kMostEntries)
      return found->size();
    refuse(pointer);
    return 0;
  }
  [[nodiscard]] bool is_number(const std::string& pointer) const {
    const Json* found = find(pointer);
    return found != nullptr && found->is_number();
  }
  [[nodiscard]] bool is_true(const std::string& pointer) const {
    const Json* found = find(pointer);
    return found != nullptr && found->is_boolean() && found->get<bool>();
  }
  [[nodiscard]] const Status& status() const { return status_; }

 private:
  [[nodiscard]] const Json* find(const std::string& pointer) const {
    const Json::json_pointer place(pointer);
    return json_.contains(place) ? &json_.at(place) : nullptr;
  }
  void refuse(const std::string& pointer) {
    if (!status_) return;
    status_ = fail(Code::kInternal,
                   fmt::format("the worker's calibration has no usable {}; check that "
                               "workers.program is hydroprint-worker",
                               pointer),
                   "WORKER_UNUSABLE");
  }

  const Json& json_;
  Status status_;
};

void read_marker(Reader& from, const std::string& at, v1::Calibration::Marker& out) {
  out.set_name(from.text(at + "/name"));
  out.set_used(from.is_true(at + "/used"));
  if (!out.used()) {
    out.set_why_not(from.text(at + "/why_not"));
    return;
  }
  out.set_rms_mm(from.number(at + "/rms_mm"));
  out.set_residual_mm(from.number(at + "/residual_mm"));
}

void read_water(Reader& from, v1::Calibration& out) {
  if (from.is_number("/water/z_mm")) {
    out.set_water_z_mm(from.number("/water/z_mm"));
    out.set_water_sigma_mm(from.number("/water/sigma_mm"));
  }
  out.set_height_mm(from.number("/height_mm"));
}

}  // namespace

Status read_calibration(const std::string& text, v1::Calibration& out) {
  const Json json = Json::parse(text, nullptr, false);
  Reader from(json);
  from.numbers("/pose/rotation_wxyz", 4, *out.mutable_pose()->mutable_rotation_wxyz(), 1.001);
  from.numbers("/pose/translation_mm", 3, *out.mutable_pose()->mutable_translation_mm());
  for (int row = 0; row < 6; ++row) {
    from.numbers(fmt::format("/uncertainty/covariance_turn_rad_shift_mm/{}", row), 6,
                 *out.mutable_covariance(), 1e12);
  }
  from.numbers("/uncertainty/about_mm", 3, *out.mutable_centre_mm());
  out.set_error_p50_mm(from.number("/uncertainty/error_p50_mm"));
  out.set_error_p95_mm(from.number("/uncertainty/error_p95_mm"));
  out.set_error_max_mm(from.number("/uncertainty/error_max_mm"));
  for (std::size_t i = 0; i < from.size("/from_nominal_pose"); ++i) {
    out.add_from_nominal_pose(from.text(fmt::format("/from_nominal_pose/{}", i)));
  }
  for (std::size_t i = 0; i < from.size("/symmetries"); ++i) {
    out.add_symmetries(from.text(fmt::format("/symmetries/{}", i)));
  }
  const std::string markers = "/film_frame/markers";
  for (std::size_t i = 0; i < from.size(markers); ++i) {
    read_marker(from, fmt::format("{}/{}", markers, i), *out.add_markers());
  }
  read_water(from, out);
  return from.status();
}

Status read_camera(const std::string& text, v1::Calibration& out) {
  const Json json = Json::parse(text, nullptr, false);
  Reader from(json);
  out.set_views(static_cast<std::int32_t>(from.number("/views", 1000)));
  out.set_rms_mm(from.number("/rms_mm"));
  return from.status();
}

}  // namespace hydroprint::daemon
