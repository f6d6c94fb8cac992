#include "sim/calibrate/camera_file.h"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "sim/base/checked_json.h"
#include "sim/calibrate/pattern_json.h"

namespace hydroprint::calibrate {
namespace {

using scan::Lens;
using Json = nlohmann::ordered_json;

/// Names of the parameters, in the order of Lens::parameters().
constexpr std::array<const char*, Lens::kParameters> kNames = {
    "fx_px", "fy_px", "cx_px", "cy_px", "k1", "k2", "p1", "p2", "depth_scale"};

bool is_lens(const Lens& lens) {
  const auto is_side = [](int px) { return px >= 16 && px <= 4096; };
  const Lens::Vector p = lens.parameters();
  return is_side(lens.width_px) && is_side(lens.height_px) && p.allFinite() && lens.fx_px > 1 &&
         lens.fy_px > 1 && p.segment<4>(4).cwiseAbs().maxCoeff() < 10 && lens.depth_scale > 0.1 &&
         lens.depth_scale < 10;
}

}  // namespace

std::string camera_json(const registration::CameraCalibration& camera) {
  Json out = {{"width_px", camera.lens.width_px}, {"height_px", camera.lens.height_px}};
  const Lens::Vector parameters = camera.lens.parameters();
  for (Eigen::Index i = 0; i < Lens::kParameters; ++i)
    out[kNames[static_cast<std::size_t>(i)]] = parameters[i];
  out["covariance"] = Json::array();
  for (const auto& row : camera.covariance.rowwise())
    out["covariance"].push_back(std::vector<double>(row.begin(), row.end()));
  out.update(
      {{"views", camera.views}, {"rms_mm", camera.rms_mm}, {"rms_sigmas", camera.rms_sigmas}});
  if (camera.pattern.is_known()) out["pattern"] = pattern_json(camera.pattern);
  return out.dump(1) + "\n";
}

Result<registration::CameraCalibration> read_camera(const std::filesystem::path& path) {
  HP_ASSIGN_OR_RETURN(const nlohmann::json json, read_json_file(path));
  registration::CameraCalibration out;
  bool has_pattern = true;
  try {
    Lens::Vector parameters;
    for (Eigen::Index i = 0; i < Lens::kParameters; ++i) {
      parameters[i] = json.at(kNames[static_cast<std::size_t>(i)]).get<double>();
      for (Eigen::Index j = 0; j < Lens::kParameters; ++j)
        out.covariance(i, j) = json.at("covariance")
                                   .at(static_cast<std::size_t>(i))
                                   .at(static_cast<std::size_t>(j))
                                   .get<double>();
    }
    out.lens.width_px = json.at("width_px").get<int>();
    out.lens.height_px = json.at("height_px").get<int>();
    out.lens = out.lens.with(parameters);
    out.views = json.at("views").get<std::size_t>();
    out.rms_mm = json.at("rms_mm").get<double>();
    out.rms_sigmas = json.at("rms_sigmas").get<double>();
    if (json.contains("pattern") && is_lens(out.lens)) {
      auto pattern = pattern_of(json["pattern"], out.lens.width_px, out.lens.height_px);
      has_pattern = pattern.has_value();
      if (pattern) out.pattern = std::move(*pattern);
    }
  } catch (const nlohmann::json::exception&) {
    return fail(Code::kInvalidArgument,
                path.string() + ": not a camera calibration. Create one with calibrate-camera");
  }
  if (!is_lens(out.lens) || !out.covariance.allFinite())
    return fail(Code::kInvalidArgument,
                path.string() + ": lens parameters out of range. Calibrate the camera again");
  if (!has_pattern)
    return fail(Code::kInvalidArgument,
                path.string() +
                    ": the fixed pattern is invalid or does not match the image size. "
                    "Calibrate the camera again");
  return out;
}

}  // namespace hydroprint::calibrate
