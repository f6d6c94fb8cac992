#include "daemon/http/server.h"

#include "daemon/http/connection.h"
#include "daemon/http/server_context.h"
#include "daemon/rest/openapi/openapi.h"

namespace hydroprint::http {
namespace {

constexpr milliseconds kStopPatience{2000};
// Maximum number of connections beyond Limits::connections that get an error response at the same
// time. Further connections are closed without a response.
constexpr int kMaxRejected = 64;

}  // namespace

struct Server::Impl {
  std::unique_ptr<TcpListener> listener;
  std::unique_ptr<ServerContext> server;
  bool is_stopped = false;

  void take(const std::shared_ptr<Socket>& socket) const {
    const int open = server->connections.count();
    const bool is_beyond = open >= server->options.limits.connections + kMaxRejected;
    if (is_beyond) server->metrics.count_refused_connection();
    if (is_beyond || !server->connections.add(socket)) return socket->close();
    open < server->options.limits.connections ? serve(*server, socket) : turn_away(*server, socket);
  }
};

Server::Server() : impl_(std::make_unique<Impl>()) {}
Server::~Server() { stop(); }

Result<std::unique_ptr<Server>> Server::start(const Options& options,
                                              std::shared_ptr<grpc::Channel> channel,
                                              Sources sources) {
  std::unique_ptr<Server> server(new Server);
  Impl& impl = *server->impl_;
  HP_ASSIGN_OR_RETURN(impl.listener,
                      TcpListener::listen(options.host, options.port, options.identity));
  HP_ASSIGN_OR_RETURN(rest::Transcoder transcoder, rest::Transcoder::make());
  HP_ASSIGN_OR_RETURN(std::string openapi, rest::openapi());
  HP_ASSIGN_OR_RETURN(StaticFiles files, StaticFiles::load(options.web_dir));
  impl.server.reset(new ServerContext{options,
                                      std::move(sources),
                                      *impl.listener,
                                      InProcessChannel(std::move(channel)),
                                      std::move(transcoder),
                                      std::move(openapi),
                                      std::move(files),
                                      {},
                                      {}});
  impl.listener->start([&impl](const std::shared_ptr<Socket>& socket) { impl.take(socket); });
  return server;
}

int Server::port() const { return impl_->listener->port(); }

void Server::stop_accepting() { impl_->listener->stop_accepting(); }

void Server::stop() {
  if (!impl_->server || std::exchange(impl_->is_stopped, true)) return;
  impl_->listener->stop_accepting();
  impl_->server->connections.close_all();
  const bool all_ended = impl_->server->connections.wait_for_none(kStopPatience) &&
                         impl_->server->rpc.wait_for_none(kStopPatience);
  impl_->listener->stop();
  // A call that has not ended may still use these objects in its callback, so they are leaked.
  if (!all_ended)
    static_cast<void>(impl_->listener.release()), static_cast<void>(impl_->server.release());
}

}  // namespace hydroprint::http
