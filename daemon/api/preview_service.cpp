#include <fmt/format.h>

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

void add_mesh(const PreviewFrame& frame, bool with_mesh, v1::Preview& out) {
  const Json head = Json::parse(frame.head);
  out.set_vertices(head.at("vertices").get<std::int64_t>());
  out.set_triangles(head.at("triangles").get<std::int64_t>());
  add_warnings(head, out);
  if (!with_mesh) return;
  const std::size_t cut =
      std::min(frame.bytes.size(), 12 * static_cast<std::size_t>(out.vertices()));
  out.set_vertex_positions(frame.bytes.substr(0, cut));
  out.set_triangle_corners(frame.bytes.substr(cut));
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

  grpc::Status ComputePreview(grpc::ServerContext* context,
                              const v1::ComputePreviewRequest* request,
                              v1::Preview* reply) override {
    return to_grpc(compute(*context, *request, *reply));
  }

 private:
  Status compute(const grpc::ServerContext& context, const v1::ComputePreviewRequest& request,
                 v1::Preview& reply) {
    HP_RETURN_IF_ERROR(check_serving(backend_));
    HP_ASSIGN_OR_RETURN(const auth::Caller caller, caller_of(context));
    const std::string& owner = caller.name;
    HP_RETURN_IF_ERROR(check_may_use_files(caller, request, backend_.database));
    HP_ASSIGN_OR_RETURN(const PreviewRequest ask, check_preview(request));
    HP_ASSIGN_OR_RETURN(PreviewResult shown, backend_.previews.compute(owner, ask, [&context] {
      return context.IsCancelled();
    }));
    try {
      add_mesh(*shown.mesh, request.with_mesh(), reply);
      add_dip(std::move(shown.dip), reply);
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
