#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "daemon/api/services.h"
#include "daemon/auth/visibility.h"
#include "daemon/rpc/caller_metadata.h"
#include "daemon/rpc/grpc_status.h"
#include "daemon/store/to_proto.h"
#include "hydroprint/v1/preview_service.grpc.pb.h"

namespace hydroprint::daemon {
namespace {

using Json = nlohmann::json;

// Copies the warnings of the worker. Throws an exception of the JSON library if a key is missing.
void add_warnings(const Json& head, v1::Preview& out) {
  for (const Json& entry : head.at("warnings")) {
    v1::Preview::Warning& warning = *out.add_warnings();
    warning.set_code(entry.at("code").get<std::string>());
    warning.set_message(entry.at("message").get<std::string>());
    warning.set_where(entry.at("where").get<std::string>());
  }
}

void add_model(PreviewFrame frame, v1::DisplayModel& out) {
  const Json head = Json::parse(frame.head);
  google::protobuf::util::JsonParseOptions options;
  options.ignore_unknown_fields = true;
  const auto read = google::protobuf::util::JsonStringToMessage(head.at("summary").dump(),
                                                                out.mutable_summary(), options);
  if (!read.ok()) throw Json::other_error::create(0, read.ToString(), &head);
  out.set_glb(std::move(frame.bytes));
}

void add_dip(PreviewFrame frame, v1::Preview& out) {
  const Json head = Json::parse(frame.head);
  const auto number = [](const Json& json) { return json.is_number() ? json.get<double>() : NAN; };
  for (const double x : head.at("pose").at("rotation_wxyz"))
    out.mutable_pose()->add_rotation_wxyz(x);
  for (const double x : head.at("pose").at("translation_mm")) {
    out.mutable_pose()->add_translation_mm(x);
  }
  out.set_depth_mm(number(head.at("depth_mm")));
  out.set_coverage(number(head.at("coverage")));
  out.set_theta_clamped_share(number(head.at("theta_clamped_share")));
  out.set_stretch_p50(number(head.at("stretch").at("p50")));
  out.set_stretch_p95(number(head.at("stretch").at("p95")));
  out.set_stretch_max(number(head.at("stretch").at("max")));
  out.set_seconds(number(head.at("seconds")));
  add_warnings(head, out);
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
                  "WORKER_UNUSABLE");
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
