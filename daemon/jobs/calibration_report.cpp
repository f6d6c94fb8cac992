#include "daemon/jobs/calibration_report.h"

#include <fmt/format.h>

#include <cmath>

#include "hydroprint/v1/calibration_service.pb.h"
#include "hydroprint/v1/report.pb.h"

namespace hydroprint::daemon {
namespace {

using Numbers = google::protobuf::RepeatedField<double>;
using Texts = google::protobuf::RepeatedPtrField<std::string>;

constexpr int kMostEntries = 100;
constexpr std::size_t kLongestText = 1000;
constexpr double kFarthest_mm = 1e5;
constexpr int kMostViews = 1000;

/// Copies checked values, and keeps the first error.
class Checked {
 public:
  double number(const char* name, double value, double most = kFarthest_mm) {
    check(name, std::abs(value) <= most);
    return value;
  }
  Numbers numbers(const char* name, const Numbers& values, int count, double most = kFarthest_mm) {
    check(name, values.size() == count);
    for (const double value : values) number(name, value, most);
    return values;
  }
  void texts(const char* name, const Texts& values, Texts& out) {
    check(name, values.size() <= kMostEntries);
    for (const std::string& value : values) *out.Add() = text(value);
  }
  /// Truncates a text if it is too long, and replaces unprintable characters by '?'.
  static std::string text(const std::string& all) {
    std::string out;
    for (const unsigned char c : all.substr(0, kLongestText)) {
      out += c >= ' ' && c < 0x7f ? static_cast<char>(c) : '?';
    }
    return out;
  }
  void check(const char* name, bool is_usable) {
    if (is_usable || !status_) return;
    status_ = fail(Code::kInternal,
                   fmt::format("the worker's calibration has no usable {}; check that "
                               "workers.program is hydroprint-worker",
                               name),
                   ErrorReason::WORKER_UNUSABLE);
  }
  [[nodiscard]] const Status& status() const { return status_; }

 private:
  Status status_;
};

void take_pose(const v1::Pose& pose, Checked& checked, v1::Pose& out) {
  *out.mutable_rotation_wxyz() = checked.numbers("pose.rotation_wxyz", pose.rotation_wxyz(), 4);
  *out.mutable_translation_mm() = checked.numbers("pose.translation_mm", pose.translation_mm(), 3);
  double squares = 0;
  for (const double value : pose.rotation_wxyz()) squares += value * value;
  checked.check("pose.rotation_wxyz", std::abs(squares - 1) <= 1e-3);
}

void take_marker(const v1::FilmFrameFacts::Marker& marker, Checked& checked,
                 v1::Calibration::Marker& out) {
  out.set_name(Checked::text(marker.name()));
  out.set_used(marker.used());
  if (!out.used()) return out.set_why_not(Checked::text(marker.why_not()));
  checked.check("marker", marker.has_rms_mm() && marker.has_residual_mm());
  out.set_rms_mm(checked.number("marker", marker.rms_mm()));
  out.set_residual_mm(checked.number("marker", marker.residual_mm()));
}

}  // namespace

Status take_calibration(const v1::CalibrationFacts& facts, v1::Calibration& out) {
  Checked checked;
  take_pose(facts.pose(), checked, *out.mutable_pose());
  const v1::CalibrationFacts::Uncertainty& uncertainty = facts.uncertainty();
  *out.mutable_covariance() =
      checked.numbers("covariance", uncertainty.covariance_turn_rad_shift_mm(), 36, 1e12);
  *out.mutable_centre_mm() = checked.numbers("uncertainty.about_mm", uncertainty.about_mm(), 3);
  out.set_error_p50_mm(checked.number("error_p50_mm", uncertainty.error_p50_mm()));
  out.set_error_p95_mm(checked.number("error_p95_mm", uncertainty.error_p95_mm()));
  out.set_error_max_mm(checked.number("error_max_mm", uncertainty.error_max_mm()));
  checked.texts("from_nominal_pose", facts.from_nominal_pose(), *out.mutable_from_nominal_pose());
  checked.texts("symmetries", facts.symmetries(), *out.mutable_symmetries());
  checked.check("markers", facts.film_frame().markers_size() <= kMostEntries);
  for (const v1::FilmFrameFacts::Marker& marker : facts.film_frame().markers())
    take_marker(marker, checked, *out.add_markers());
  if (facts.has_water()) {
    out.set_water_z_mm(checked.number("water.z_mm", facts.water().z_mm()));
    out.set_water_sigma_mm(checked.number("water.sigma_mm", facts.water().sigma_mm()));
  }
  out.set_height_mm(checked.number("height_mm", facts.height_mm()));
  return checked.status();
}

Status take_camera(const v1::CalibrateCameraReport& report, v1::Calibration& out) {
  Checked checked;
  checked.check("views", report.views() > 0 && report.views() <= kMostViews);
  out.set_views(report.views());
  out.set_rms_mm(checked.number("rms_mm", report.rms_mm()));
  return checked.status();
}

}  // namespace hydroprint::daemon
