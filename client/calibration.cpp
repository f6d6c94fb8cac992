#include "client/calibration.h"

#include <algorithm>
#include <utility>

#include "client/connection/rpc.h"
#include "client/convert.h"
#include "client/uuid.h"

namespace hydroprint::client {
namespace {

using Stub = v1::CalibrationService::Stub;

CalibrationMarker marker_of(const v1::Calibration::Marker& message) {
  return {message.name(), message.used(), message.why_not(), message.rms_mm(),
          message.residual_mm()};
}

void take_object(const v1::Calibration& message, Calibration& out) {
  out.mesh = {message.mesh().name(), message.mesh().asset()};
  out.scale = message.scale();
  out.film = message.film();
  if (message.has_pose()) out.pose = pose_from_proto(message.pose());
  out.covariance.assign(message.covariance().begin(), message.covariance().end());
  out.centre_mm.assign(message.centre_mm().begin(), message.centre_mm().end());
  out.error_p50_mm = given(message.has_error_p50_mm(), message.error_p50_mm());
  out.error_p95_mm = given(message.has_error_p95_mm(), message.error_p95_mm());
  out.error_max_mm = given(message.has_error_max_mm(), message.error_max_mm());
  out.from_nominal_pose.assign(message.from_nominal_pose().begin(),
                               message.from_nominal_pose().end());
  for (const auto& marker : message.markers()) out.markers.push_back(marker_of(marker));
  out.water_z_mm = given(message.has_water_z_mm(), message.water_z_mm());
  out.water_sigma_mm = given(message.has_water_sigma_mm(), message.water_sigma_mm());
  out.height_mm = given(message.has_height_mm(), message.height_mm());
  out.axis_mm = given(message.has_axis_mm(), message.axis_mm());
  out.contact_mm = given(message.has_contact_mm(), message.contact_mm());
}

Calibration calibration_of(const v1::Calibration& message) {
  Calibration out;
  out.name = message.name();
  out.kind = v1::Calibration::Kind_Name(message.kind());
  out.display_name = message.display_name();
  out.owner = message.owner();
  out.create_time = from_proto(message.has_create_time(), message.create_time());
  out.capture_time = from_proto(message.has_capture_time(), message.capture_time());
  out.active = message.active();
  out.job = message.job();
  out.picture = message.picture();
  for (const int why : message.stale()) {
    out.stale.push_back(
        v1::Calibration::Staleness_Name(static_cast<v1::Calibration::Staleness>(why)));
  }
  if (message.kind() == v1::Calibration::OBJECT) take_object(message, out);
  out.views = message.views();
  out.rms_mm = message.rms_mm();
  return out;
}

Result<Calibration> to_calibration(Result<v1::Calibration> answer) {
  return std::move(answer).map([](const v1::Calibration& found) { return calibration_of(found); });
}

}  // namespace

Result<std::vector<Calibration>> list_calibrations(Connection& connection, int limit) {
  std::vector<Calibration> out;
  v1::ListCalibrationsRequest request;
  do {
    request.set_page_size(std::min(kPageSize, limit - static_cast<int>(out.size())));
    HP_ASSIGN_OR_RETURN(
        const v1::ListCalibrationsResponse page,
        call(connection, *connection.impl().calibrations, &Stub::ListCalibrations, request));
    for (const auto& calibration : page.calibrations()) out.push_back(calibration_of(calibration));
    request.set_page_token(page.next_page_token());
  } while (!request.page_token().empty() && std::ssize(out) < limit);
  return out;
}

Result<Calibration> get_calibration(Connection& connection, const std::string& name) {
  v1::GetCalibrationRequest request;
  request.set_name(name);
  return to_calibration(
      call(connection, *connection.impl().calibrations, &Stub::GetCalibration, request));
}

Result<Calibration> create_calibration(Connection& connection, const Calibration& entered) {
  v1::CreateCalibrationRequest request;
  v1::Calibration& message = *request.mutable_calibration();
  message.set_display_name(entered.display_name);
  message.mutable_mesh()->set_name(entered.mesh.name);
  message.mutable_mesh()->set_asset(entered.mesh.asset);
  message.set_scale(entered.scale);
  message.set_film(entered.film);
  if (entered.pose) *message.mutable_pose() = pose_to_proto(*entered.pose);
  request.set_request_id(make_uuid());
  return to_calibration(
      call(connection, *connection.impl().calibrations, &Stub::CreateCalibration, request));
}

Result<Calibration> activate_calibration(Connection& connection, const std::string& name) {
  v1::ActivateCalibrationRequest request;
  request.set_name(name);
  return to_calibration(
      call(connection, *connection.impl().calibrations, &Stub::ActivateCalibration, request));
}

Status delete_calibration(Connection& connection, const std::string& name) {
  v1::DeleteCalibrationRequest request;
  request.set_name(name);
  HP_RETURN_IF_ERROR(
      call(connection, *connection.impl().calibrations, &Stub::DeleteCalibration, request));
  return {};
}

}  // namespace hydroprint::client
