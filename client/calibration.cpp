#include "client/calibration.h"

#include "client/connection/rpc.h"
#include "client/uuid.h"

namespace hydroprint::client {
namespace {

using CalibrationStub = v1::CalibrationService::Stub;

CalibrationStub& calibrations(Connection& connection) { return *connection.impl().calibrations; }

}  // namespace

Result<v1::ListCalibrationsResponse> list_calibrations(Connection& connection, int limit) {
  return all_pages(connection, calibrations(connection), &CalibrationStub::ListCalibrations,
                   v1::ListCalibrationsRequest(), &v1::ListCalibrationsResponse::calibrations_size,
                   limit);
}

Result<v1::Calibration> get_calibration(Connection& connection, const std::string& name) {
  return call(connection, calibrations(connection), &CalibrationStub::GetCalibration,
              named<v1::GetCalibrationRequest>(name));
}

Result<v1::Calibration> create_calibration(Connection& connection, const v1::Calibration& entered) {
  v1::CreateCalibrationRequest request;
  *request.mutable_calibration() = entered;
  request.set_request_id(make_uuid());
  return call(connection, calibrations(connection), &CalibrationStub::CreateCalibration, request);
}

Result<v1::Calibration> activate_calibration(Connection& connection, const std::string& name) {
  return call(connection, calibrations(connection), &CalibrationStub::ActivateCalibration,
              named<v1::ActivateCalibrationRequest>(name));
}

Status delete_calibration(Connection& connection, const std::string& name) {
  HP_RETURN_IF_ERROR(call(connection, calibrations(connection), &CalibrationStub::DeleteCalibration,
                          named<v1::DeleteCalibrationRequest>(name)));
  return {};
}

}  // namespace hydroprint::client
