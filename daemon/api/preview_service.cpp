#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "daemon/api/services.h"
#include "daemon/auth/visibility.h"
#include "daemon/rest/json_text.h"
#include "daemon/rpc/caller_metadata.h"
#include "daemon/rpc/grpc_status.h"
#include "daemon/store/to_proto.h"
#include "hydroprint/v1/preview_service.grpc.pb.h"

namespace hydroprint::daemon {
namespace {

using Json = nlohmann::json;

// Reads a message that the worker wrote as JSON.
void read_message(const Json& json, google::protobuf::Message& out) {
  const Status read = rest::read_json(json.dump(), out, out.GetDescriptor()->name());
  if (!read) throw Json::other_error::create(0, read.error().message, &json);
}

void add_model(PreviewFrame frame, v1::DisplayModel& out) {
  read_message(Json::parse(frame.head).at("summary"), *out.mutable_summary());
  out.set_glb(std::move(frame.bytes));
}

void add_dip(PreviewFrame frame, v1::Preview& out) {
  const Json head = Json::parse(frame.head);
  const auto number = [](const Json& json) { return json.is_number() ? json.get<double>() : NAN; };
  read_message(head.at("pose"), *out.mutable_pose());
  out.set_depth_mm(number(head.at("depth_mm")));
  out.set_coverage(number(head.at("coverage")));
  out.set_theta_clamped_share(number(head.at("theta_clamped_share")));
  out.set_stretch_p50(number(head.at("stretch").at("p50")));
  out.set_stretch_p95(number(head.at("stretch").at("p95")));
  out.set_stretch_max(number(head.at("stretch").at("max")));
  out.set_seconds(number(head.at("seconds")));
  for (const Json& warning : head.at("warnings")) read_message(warning, *out.add_warnings());
  out.set_vertex_map(std::move(frame.bytes));
}

class PreviewService final : public v1::PreviewService::Service {
 public:
  explicit PreviewService(const ServiceContext& backend) : backend_(backend) {}

  grpc::Status ReadModel(grpc::ServerContext* context, const v1::ReadModelRequest* request,
                         v1::DisplayModel* reply) override {
    return to_grpc(answer(*context, *request, check_read, add_model, *reply));
  }

  grpc::Status ComputePreview(grpc::ServerContext* context,
                              const v1::ComputePreviewRequest* request,
                              v1::Preview* reply) override {
    return to_grpc(answer(*context, *request, check_preview, add_dip, *reply));
  }

 private:
  // Has a worker answer a request.
  // @param check  translates the request for the worker
  // @param add  copies the worker's answer to the reply; throws an exception of the JSON library
  template <class Request, class Reply>
  Status answer(const grpc::ServerContext& context, const Request& request,
                Result<PreviewRequest> (*check)(const Request&), void (*add)(PreviewFrame, Reply&),
                Reply& reply) {
    HP_RETURN_IF_ERROR(check_serving(backend_));
    HP_ASSIGN_OR_RETURN(const auth::Caller caller, caller_of(context));
    HP_RETURN_IF_ERROR(check_may_use_files(caller, request, backend_.database));
    HP_ASSIGN_OR_RETURN(const PreviewRequest ask, check(request));
    const auto is_gone = [&context] { return context.IsCancelled(); };
    HP_ASSIGN_OR_RETURN(PreviewFrame frame, backend_.previews.compute(caller.name, ask, is_gone));
    try {
      add(std::move(frame), reply);
    } catch (const Json::exception& error) {
      return fail(Code::kInternal,
                  fmt::format("the worker's preview cannot be read: {}; check that workers.program "
                              "is hydroprint-worker",
                              error.what()),
                  ErrorReason::WORKER_UNUSABLE);
    }
    return {};
  }

  ServiceContext backend_;
};

}  // namespace

std::unique_ptr<grpc::Service> make_preview_service(const ServiceContext& backend) {
  return std::make_unique<PreviewService>(backend);
}

}  // namespace hydroprint::daemon
