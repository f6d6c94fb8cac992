#include "daemon/api/services.h"
#include "daemon/auth/visibility.h"
#include "daemon/jobs/calibration_binding.h"
#include "daemon/jobs/entered_calibration.h"
#include "daemon/jobs/field_check.h"
#include "daemon/platform/log.h"
#include "daemon/platform/resource_names.h"
#include "daemon/rpc/caller_metadata.h"
#include "daemon/rpc/grpc_status.h"
#include "daemon/store/to_proto.h"
#include "hydroprint/v1/calibration_service.grpc.pb.h"

namespace hydroprint::daemon {
namespace {

class CalibrationService final : public v1::CalibrationService::Service {
 public:
  explicit CalibrationService(const ServiceContext& backend) : backend_(backend) {}

  grpc::Status ListCalibrations(grpc::ServerContext* context,
                                const v1::ListCalibrationsRequest* request,
                                v1::ListCalibrationsResponse* reply) override {
    return to_grpc(list(*context, *request, *reply));
  }

  grpc::Status GetCalibration(grpc::ServerContext* context,
                              const v1::GetCalibrationRequest* request,
                              v1::Calibration* reply) override {
    return answer(*context, find_calibration(request->name(), backend_.calibrations), reply);
  }

  grpc::Status CreateCalibration(grpc::ServerContext* context,
                                 const v1::CreateCalibrationRequest* request,
                                 v1::Calibration* reply) override {
    return answer(*context, create(*context, *request), reply);
  }

  grpc::Status ActivateCalibration(grpc::ServerContext* context,
                                   const v1::ActivateCalibrationRequest* request,
                                   v1::Calibration* reply) override {
    return answer(*context, activate(request->name()), reply);
  }

  grpc::Status DeleteCalibration(grpc::ServerContext*, const v1::DeleteCalibrationRequest* request,
                                 google::protobuf::Empty*) override {
    return to_grpc(remove(request->name()));
  }

 private:
  grpc::Status answer(const grpc::ServerContext& context, const Result<Calibration>& calibration,
                      v1::Calibration* reply) {
    const auto caller = caller_of(context);
    if (!caller) return to_grpc(caller.error());
    if (!calibration) return to_grpc(calibration.error());
    *reply = to_message(*calibration, backend_.places.place());
    hide_files(*caller, *reply);
    return grpc::Status::OK;
  }

  Status list(const grpc::ServerContext& context, const v1::ListCalibrationsRequest& request,
              v1::ListCalibrationsResponse& reply) {
    HP_ASSIGN_OR_RETURN(const auth::Caller caller, caller_of(context));
    HP_ASSIGN_OR_RETURN(const int size, page_size(request.page_size(), 50));
    HP_ASSIGN_OR_RETURN(const std::int64_t before, number_token(request.page_token()));
    HP_ASSIGN_OR_RETURN(auto found, backend_.calibrations.list(before, size + 1));
    if (cut_page(found, size)) reply.set_next_page_token(std::to_string(found.back().id));
    const RigPlace now = backend_.places.place();
    for (const Calibration& calibration : found) {
      v1::Calibration& message = *reply.add_calibrations();
      message = to_message(calibration, now);
      hide_files(caller, message);
    }
    return {};
  }

  Result<Calibration> create(const grpc::ServerContext& context,
                             const v1::CreateCalibrationRequest& request) {
    HP_RETURN_IF_ERROR(check_serving(backend_));
    HP_RETURN_IF_ERROR(check_fields(request));
    HP_ASSIGN_OR_RETURN(const v1::Calibration entered, check_calibration(request.calibration()));
    HP_ASSIGN_OR_RETURN(const std::string mesh, parse_asset_name(entered.mesh().asset()));
    HP_RETURN_IF_ERROR(backend_.jobs.check_inputs({{entered.mesh().name(), mesh}}));
    NewCalibration definition;
    HP_ASSIGN_OR_RETURN(definition.owner, owner_of(context));
    definition.body = entered.SerializeAsString();
    HP_ASSIGN_OR_RETURN(
        const Calibration out,
        backend_.calibrations.create(definition, request_key("CreateCalibration", request)));
    log(LogLevel::kInfo, "calibration_entered",
        {{"calibration", calibration_name(out.id)}, {"owner", definition.owner}});
    return out;
  }

  Result<Calibration> activate(const std::string& name) {
    HP_ASSIGN_OR_RETURN(const std::int64_t id, parse_calibration_name(name));
    return backend_.calibrations.activate(id);
  }

  Status remove(const std::string& name) {
    HP_ASSIGN_OR_RETURN(const std::int64_t id, parse_calibration_name(name));
    HP_RETURN_IF_ERROR(backend_.calibrations.remove(id));
    log(LogLevel::kInfo, "calibration_deleted", {{"calibration", name}});
    return {};
  }

  ServiceContext backend_;
};

}  // namespace

std::unique_ptr<grpc::Service> make_calibration_service(const ServiceContext& backend) {
  return std::make_unique<CalibrationService>(backend);
}

}  // namespace hydroprint::daemon
