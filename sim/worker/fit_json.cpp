#include "sim/worker/fit_json.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <map>

namespace hydroprint::worker {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kMethod =
    "Gauss-Newton least squares of predicted minus measured printed points on the film, drag "
    "fitted as 1/drag_length_mm^2; covariance by leaving out one point at a time (linearised "
    "jackknife), to which the computation's own error is added: what is left of the difference "
    "that 0.6 times finer meshes and steps make; intervals by Student's t, cut where the profile's "
    "range ends, one-sided for an estimate that lies there";

/// JSON has no infinity; a drag length without end is null.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json estimate_json(const fit::Estimate& e) {
  Json out = {{"name", e.name},
              {"start", number(e.start)},
              {"value", number(e.value)},
              {"standard_error", number(e.standard_error)},
              {"interval", {number(e.low), number(e.high)}},
              {"one_sided", e.is_one_sided},
              {"discretisation_share", e.discretisation_error / e.scaled_error}};
  return out;
}

Json estimates_json(const fit::Outcome& outcome) {
  Json out = Json::array();
  for (const fit::Estimate& e : outcome.estimates) out.push_back(estimate_json(e));
  return out;
}

Json correlation_json(const fit::Outcome& outcome) {
  Json out = Json::array();
  for (Eigen::Index i = 0; i < outcome.correlation.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < outcome.correlation.cols(); ++j) {
      row.push_back(outcome.correlation(i, j));
    }
    out.push_back(row);
  }
  return out;
}

Json undetermined_json(const fit::Outcome& outcome) {
  Json out = Json::array();
  for (const fit::Undetermined& u : outcome.undetermined) {
    out.push_back({{"name", u.name}, {"reason", u.reason}});
  }
  return out;
}

Json points_json(const fit::Outcome& outcome) {
  std::map<std::string, int> reasons;
  int used = 0, outliers = 0;
  for (const fit::PointResult& p : outcome.points) {
    used += p.is_used() ? 1 : 0;
    outliers += p.is_outlier ? 1 : 0;
    if (!p.is_used()) ++reasons[p.left_out];
  }
  Json left_out = Json::array();
  for (const auto& [reason, count] : reasons) {
    left_out.push_back({{"reason", reason}, {"points", count}});
  }
  return {{"given", outcome.points.size()},
          {"used", used},
          {"outliers", outliers},
          {"left_out", left_out}};
}

Json names_json(const fit::Outcome& outcome) {
  Json out = Json::array();
  for (const fit::Estimate& e : outcome.estimates) out.push_back(e.name);
  return out;
}

/// "drag_length_mm = 60.2  (95 %: 57 to 63.5)"; a drag length without end is no drag.
std::string estimate_text(const fit::Estimate& e) {
  const auto text = [](double value) -> std::string {
    if (!std::isfinite(value)) return "none";
    std::array<char, 32> buffer{};
    std::snprintf(buffer.data(), buffer.size(), "%.5g", value);
    return buffer.data();
  };
  return e.name + " = " + text(e.value) + "  (95 %: " + text(e.low) +
         (std::isfinite(e.high) ? " to " + text(e.high) : " or more, or none") + ")\n";
}

}  // namespace

Json fit_json(const fit::Outcome& outcome, const fit::Options& options) {
  return {{"confidence", fit::kConfidence},
          {"method", kMethod},
          {"drop_outliers", options.drop_outliers},
          {"estimates", estimates_json(outcome)},
          {"correlation", {{"names", names_json(outcome)}, {"matrix", correlation_json(outcome)}}},
          {"undetermined", undetermined_json(outcome)},
          {"points", points_json(outcome)},
          {"rms_before_mm", number(outcome.rms_before_mm)},
          {"rms_after_mm", number(outcome.rms_after_mm)},
          {"residual_sigma_mm", number(outcome.residual_sigma_mm)},
          {"discretisation_mm", outcome.discretisation_mm},
          {"degrees_of_freedom", outcome.degrees_of_freedom},
          {"student_t", outcome.t_quantile},
          {"iterations", outcome.iterations},
          {"dips", outcome.dips},
          {"settled", outcome.settled}};
}

Json fit_summary_json(const fit::Outcome& outcome) {
  return {{"estimates", estimates_json(outcome)},
          {"undetermined", undetermined_json(outcome)},
          {"rms_before_mm", number(outcome.rms_before_mm)},
          {"rms_after_mm", number(outcome.rms_after_mm)}};
}

std::string fit_text(const fit::Outcome& outcome, const std::filesystem::path& dir) {
  std::array<char, 120> rms{};
  std::snprintf(rms.data(), rms.size(), "residuals %.3f mm rms, %.3f mm before the fit\n",
                outcome.rms_after_mm, outcome.rms_before_mm);
  std::string out = dir.string() + "/film_profile.toml: " + rms.data();
  for (const fit::Estimate& e : outcome.estimates) out += estimate_text(e);
  for (const fit::Undetermined& u : outcome.undetermined) {
    out += u.name + " is not determined: " + u.reason + "\n";
  }
  return out;
}

}  // namespace hydroprint::worker
