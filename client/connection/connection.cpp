#include "client/connection/connection.h"

#include <fmt/format.h>

#include <utility>

#include "client/connection/rpc.h"
#include "client/connection/server_address.h"

namespace hydroprint::client {
namespace {

grpc::ChannelArguments channel_arguments() {
  grpc::ChannelArguments arguments;
  // The daemon is on this machine or the local network, so a proxy from the environment is ignored.
  arguments.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 100);
  arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS, 2000);  // also limits an attempt to connect
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 1000);
  arguments.SetMaxReceiveMessageSize(64 << 20);  // enough for the preview of a large mesh
  return arguments;
}

std::shared_ptr<grpc::ChannelCredentials> credentials(const ConnectionOptions& options) {
  if (!options.is_tls) return grpc::InsecureChannelCredentials();
  grpc::SslCredentialsOptions ssl;
  ssl.pem_root_certs = options.ca_pem;
  return grpc::SslCredentials(ssl);
}

}  // namespace

Status check_secrets_may_go(const ConnectionOptions& options) {
  if (options.is_tls) return {};
  HP_ASSIGN_OR_RETURN(const ServerAddress address, parse_server(options.server));
  if (address.is_loopback()) return {};
  return fail(
      Code::kFailedPrecondition,
      fmt::format("{0} is another machine, and without TLS a password or key could be intercepted; "
                  "use --server https://{0}, or forward a port of this machine with ssh -L",
                  options.server));
}

Connection::Impl::Impl(ConnectionOptions connection_options)
    : options(std::move(connection_options)),
      channel(grpc::CreateCustomChannel(options.server, credentials(options), channel_arguments())),
      keeps_secrets(check_secrets_may_go(options).has_value()),
      artifacts(v1::ArtifactService::NewStub(channel)),
      assets(v1::AssetService::NewStub(channel)),
      calibrations(v1::CalibrationService::NewStub(channel)),
      cameras(v1::CameraService::NewStub(channel)),
      jobs(v1::JobService::NewStub(channel)),
      leases(v1::LeaseService::NewStub(channel)),
      people(v1::PeopleService::NewStub(channel)),
      previews(v1::PreviewService::NewStub(channel)),
      queue(v1::QueueService::NewStub(channel)),
      rig(v1::RigService::NewStub(channel)) {}

Connection::Connection(ConnectionOptions options)
    : impl_(std::make_unique<Impl>(std::move(options))) {}

Connection::~Connection() = default;

const ConnectionOptions& Connection::options() const { return impl_->options; }

}  // namespace hydroprint::client
