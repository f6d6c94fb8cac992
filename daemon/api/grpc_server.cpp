#include "daemon/api/grpc_server.h"

#include <fmt/format.h>
#include <grpc/support/log.h>
#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/grpcpp.h>
#include <grpcpp/health_check_service_interface.h>
#include <grpcpp/impl/server_builder_option.h>
#include <grpcpp/impl/server_builder_plugin.h>
#include <grpcpp/resource_quota.h>

#include "daemon/api/audit_interceptor.h"
#include "daemon/api/call_forwarder.h"
#include "daemon/api/services.h"
#include "daemon/platform/log.h"
#include "daemon/tls/grpc_credentials.h"

namespace hydroprint::daemon {
namespace {

// Every watch and every running transfer occupies a thread.
constexpr int kMostThreads = 512;
// Largest size of a response. Lists can be long, because only the page size limits them.
constexpr int kMostAnswer_bytes = 64 << 20;

constexpr int kHandshake_ms = 10'000;
// Connections without calls for this time are closed; clients reconnect automatically.
constexpr int kIdle_ms = 600'000;

constexpr const char* kRigService = "hydroprint.v1.RigService";  // health: set_rig_serving()
struct NamedService {
  const char* name;
  std::unique_ptr<grpc::Service> (*make)(const ServiceContext&);
};
constexpr NamedService kServices[] = {
    {"hydroprint.v1.JobService", make_job_service},
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

// Writes gRPC's log messages to the daemon's log. Failed handshakes are caused by clients and could
// fill the log, so they are debug messages.
void log_of_grpc(gpr_log_func_args* entry) {
  const bool is_ours = entry->severity == GPR_LOG_SEVERITY_ERROR &&
                       std::string_view(entry->file).find("ssl_") == std::string_view::npos;
  log(is_ours ? LogLevel::kWarning : LogLevel::kDebug, "grpc", {{"message", entry->message}});
}

/// Builds a server without the plugins that libraries add to every server, such as reflection.
class NoPlugins final : public grpc::ServerBuilderOption {
 public:
  void UpdateArguments(grpc::ChannelArguments*) override {}
  void UpdatePlugins(std::vector<std::unique_ptr<grpc::ServerBuilderPlugin>>* plugins) override {
    plugins->clear();
  }
};

}  // namespace

struct Server::Impl {
  Impl(RoleCheck checked, const ServiceContext& backend) : roles(std::move(checked)) {
    for (const NamedService& service : kServices) services.push_back(service.make(backend));
  }

  RoleCheck roles;
  std::vector<std::unique_ptr<grpc::Service>> services;
  std::unique_ptr<grpc::Server> within;  // runs the services; listens on no port
  std::unique_ptr<CallForwarder> forwarder;
  // gRPC calls the credentials as long as the endpoint exists.
  std::shared_ptr<grpc::ServerCredentials> credentials = grpc::InsecureServerCredentials();
  std::unique_ptr<grpc::Server> server;  // the endpoint
  Endpoint endpoint;

  void start_services(bool reflection, auth::AuditLog& audit);
  Status listen(const Endpoint& wanted, tls::CurrentIdentity identity);

  void set(const char* service, bool serving) const {
    within->GetHealthCheckService()->SetServingStatus(service, serving);
  }
  void set_rig_serving(bool serving) const { set(kRigService, serving); }
  void set_serving(bool serving) const {
    set("", serving);
    for (const NamedService& service : kServices) {
      if (std::string_view(service.name) != kRigService) set(service.name, serving);
    }
    if (!serving) set_rig_serving(false);
  }
};

void Server::Impl::start_services(bool reflection, auth::AuditLog& audit) {
  grpc::EnableDefaultHealthCheckService(true);
  if (reflection) grpc::reflection::InitProtoReflectionServerBuilderPlugin();
  grpc::ServerBuilder builder;
  if (!reflection) builder.SetOption(std::make_unique<NoPlugins>());
  std::vector<std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface>> interceptors;
  interceptors.push_back(make_audit_interceptor(audit));
  builder.experimental().SetInterceptorCreators(std::move(interceptors));
  builder.SetResourceQuota(grpc::ResourceQuota("hydroprintd").SetMaxThreads(kMostThreads));
  for (const auto& service : services) builder.RegisterService(service.get());
  within = builder.BuildAndStart();
  grpc::EnableDefaultHealthCheckService(false);  // the endpoint forwards health checks to `within`
}

Status Server::Impl::listen(const Endpoint& wanted, tls::CurrentIdentity identity) {
  grpc::ServerBuilder builder;
  builder.SetOption(std::make_unique<NoPlugins>());  // `within` has the plugins
  // Otherwise a second daemon would silently share the port.
  builder.AddChannelArgument(GRPC_ARG_ALLOW_REUSEPORT, 0);
  // Disconnects clients that send nothing after connecting.
  builder.AddChannelArgument(GRPC_ARG_SERVER_HANDSHAKE_TIMEOUT_MS, kHandshake_ms);
  builder.AddChannelArgument(GRPC_ARG_MAX_CONNECTION_IDLE_MS, kIdle_ms);
  if (identity) credentials = tls_credentials(std::move(identity));
  int port = 0;
  builder.AddListeningPort(wanted.text(), credentials, &port);
  builder.RegisterCallbackGenericService(forwarder.get());
  server = builder.BuildAndStart();
  if (!server || port == 0) {
    return fail(
        Code::kUnavailable,
        fmt::format(
            "cannot listen at {}: the address may be in use, perhaps by another hydroprintd, or "
            "may not belong to this machine; stop that program or set another address with --grpc",
            wanted.text()));
  }
  endpoint = {wanted.host, port};
  return {};
}

Server::Server(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Server::~Server() = default;

Result<std::unique_ptr<Server>> Server::start(const Endpoint& endpoint, bool reflection,
                                              const ServiceContext& backend,
                                              tls::CurrentIdentity identity) {
  gpr_set_log_function(log_of_grpc);
  std::vector<std::string> names;
  for (const NamedService& service : kServices) names.emplace_back(service.name);
  HP_ASSIGN_OR_RETURN(RoleCheck roles,
                      RoleCheck::make(backend.access, names, make_refusal_recorder(backend.audit)));
  std::unique_ptr<Server> server(new Server(std::make_unique<Impl>(std::move(roles), backend)));
  Impl& impl = *server->impl_;
  impl.start_services(reflection, backend.audit);
  impl.forwarder = std::make_unique<CallForwarder>(server->in_process(), impl.roles);
  HP_RETURN_IF_ERROR(impl.listen(endpoint, std::move(identity)));
  impl.set_rig_serving(false);
  impl.set_serving(true);
  return server;
}

std::shared_ptr<grpc::Channel> Server::in_process() const {
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(kMostAnswer_bytes);
  return impl_->within->InProcessChannel(arguments);
}

const RoleCheck& Server::roles() const { return impl_->roles; }

const Endpoint& Server::endpoint() const { return impl_->endpoint; }

void Server::set_rig_serving(bool serving) { impl_->set_rig_serving(serving); }

void Server::stop(std::chrono::milliseconds patience) {
  impl_->set_serving(false);
  const auto deadline = std::chrono::system_clock::now() + patience;
  impl_->server->Shutdown(deadline);
  impl_->server->Wait();
  impl_->within->Shutdown(deadline);
  impl_->within->Wait();
}

}  // namespace hydroprint::daemon
