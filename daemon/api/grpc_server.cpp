#include "daemon/api/grpc_server.h"

#include <grpc/support/log.h>
#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/grpcpp.h>
#include <grpcpp/health_check_service_interface.h>
#include <grpcpp/resource_quota.h>

#include "daemon/api/services.h"
#include "daemon/auth/audit_interceptor.h"
#include "daemon/auth/role_check.h"
#include "daemon/platform/log.h"
#include "daemon/tls/grpc_credentials.h"

namespace hydroprint::daemon {
namespace {

// Every watch and every running transfer occupies a thread.
constexpr int kMostThreads = 512;
// Maximum size of a response; only the page size limits lists.
constexpr int kMostAnswer_bytes = 64 << 20;

constexpr int kHandshake_ms = 10'000;
constexpr int kIdle_ms = 600'000;  // without a call; clients reconnect automatically

constexpr const char* kRigService = "hydroprint.v1.RigService";  // serving while the rig works
struct Made {
  const char* name;
  std::unique_ptr<grpc::Service> (*make)(const ServiceContext&);
};
constexpr Made kServices[] = {{"hydroprint.v1.JobService", make_job_service},
                              {"hydroprint.v1.QueueService", make_queue_service},
                              {"hydroprint.v1.AssetService", make_asset_service},
                              {"hydroprint.v1.ArtifactService", make_artifact_service},
                              {"hydroprint.v1.CalibrationService", make_calibration_service},
                              {"hydroprint.v1.PreviewService", make_preview_service},
                              {"hydroprint.v1.CameraService", make_camera_service},
                              {"hydroprint.v1.LeaseService", make_lease_service},
                              {"hydroprint.v1.PeopleService", make_people_service},
                              {"hydroprint.v1.EventService", make_event_service},
                              {kRigService, make_rig_service}};

// Sends gRPC's log messages to the daemon's log. Failed TLS handshakes are not a fault of the
// daemon and could fill the log, so they are only debug messages.
void log_of_grpc(gpr_log_func_args* said) {
  const bool is_ours = said->severity == GPR_LOG_SEVERITY_ERROR &&
                       std::string_view(said->file).find("ssl_") == std::string_view::npos;
  log(is_ours ? LogLevel::kWarning : LogLevel::kDebug, "grpc", {{"message", said->message}});
}

}  // namespace

struct Server::Impl {
  Endpoint endpoint;
  std::vector<std::unique_ptr<grpc::Service>> services;
  std::shared_ptr<grpc::ServerCredentials> credentials = grpc::InsecureServerCredentials();
  std::unique_ptr<grpc::Server> server;

  void set(const char* service, bool serving) const {
    server->GetHealthCheckService()->SetServingStatus(service, serving);
  }
  void set_rig_serving(bool serving) const { set(kRigService, serving); }
  void set_serving(bool serving) const {
    set("", serving);
    for (const Made& service : kServices) {
      if (std::string_view(service.name) != kRigService) set(service.name, serving);
    }
    if (!serving) set_rig_serving(false);
  }
};

Server::Server() : impl_(std::make_unique<Impl>()) {}
Server::~Server() = default;

Result<std::unique_ptr<Server>> Server::start(const Endpoint& endpoint, bool reflection,
                                              const ServiceContext& backend,
                                              tls::CurrentIdentity identity) {
  gpr_set_log_function(log_of_grpc);
  grpc::EnableDefaultHealthCheckService(true);
  if (reflection) grpc::reflection::InitProtoReflectionServerBuilderPlugin();
  std::unique_ptr<Server> made(new Server);
  Impl& impl = *made->impl_;
  for (const Made& service : kServices) {
    HP_ASSIGN_OR_RETURN(
        auto gate, guarded(service.name, service.make(backend), backend.access, {"StopMotion"}));
    impl.services.push_back(std::move(gate));
  }

  grpc::ServerBuilder builder;
  // Otherwise a second daemon would silently share the port.
  builder.AddChannelArgument(GRPC_ARG_ALLOW_REUSEPORT, 0);
  std::vector<std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface>> taps;
  taps.push_back(make_audit_tap(backend.access, backend.audit));
  builder.experimental().SetInterceptorCreators(std::move(taps));
  builder.SetResourceQuota(grpc::ResourceQuota("hydroprintd").SetMaxThreads(kMostThreads));
  for (const auto& service : impl.services) builder.RegisterService(service.get());
  // Closes connections of clients that send nothing.
  builder.AddChannelArgument(GRPC_ARG_SERVER_HANDSHAKE_TIMEOUT_MS, kHandshake_ms);
  builder.AddChannelArgument(GRPC_ARG_MAX_CONNECTION_IDLE_MS, kIdle_ms);
  if (identity) impl.credentials = tls_credentials(std::move(identity));
  int port = 0;
  builder.AddListeningPort(endpoint.text(), impl.credentials, &port);
  impl.server = builder.BuildAndStart();
  if (!impl.server || port == 0) {
    return fail(Code::kUnavailable, "cannot listen at " + endpoint.text() +
                                        ": the port is in use, perhaps by another hydroprintd; "
                                        "stop that program or set another "
                                        "port with --grpc");
  }
  impl.endpoint = {endpoint.host, port};
  impl.set_rig_serving(false);
  impl.set_serving(true);
  return made;
}

std::shared_ptr<grpc::Channel> Server::in_process() const {
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(kMostAnswer_bytes);
  return impl_->server->InProcessChannel(arguments);
}

const Endpoint& Server::endpoint() const { return impl_->endpoint; }

void Server::set_rig_serving(bool serving) { impl_->set_rig_serving(serving); }

void Server::stop(std::chrono::milliseconds patience) {
  impl_->set_serving(false);
  impl_->server->Shutdown(std::chrono::system_clock::now() + patience);
  impl_->server->Wait();
}

}  // namespace hydroprint::daemon
