#include "daemon/http/server.h"

#include "daemon/http/site.h"
#include "daemon/rest/openapi.h"

namespace hydroprint::http {
namespace {

constexpr milliseconds kStopPatience{2000};
constexpr int kMostTurnedAway = 64;  // at a time; beyond these nobody is told

}  // namespace

struct Server::Impl {
  std::unique_ptr<Io> io;
  std::unique_ptr<Site> site;
  bool is_stopped = false;

  void take(const std::shared_ptr<Socket>& socket) const {
    const int open = site->connections.count();
    const bool is_beyond = open >= site->options.limits.connections + kMostTurnedAway;
    if (is_beyond) site->counters.count_refused_connection();
    if (is_beyond || !site->connections.add(socket)) return socket->close();
    open < site->options.limits.connections ? serve(*site, socket) : turn_away(*site, socket);
  }
};

Server::Server() : impl_(std::make_unique<Impl>()) {}
Server::~Server() { stop(); }

Result<std::unique_ptr<Server>> Server::start(const Options& options,
                                              std::shared_ptr<grpc::Channel> channel,
                                              Sources sources) {
  std::unique_ptr<Server> made(new Server);
  Impl& impl = *made->impl_;
  HP_ASSIGN_OR_RETURN(impl.io, Io::listen(options.host, options.port, options.identity));
  HP_ASSIGN_OR_RETURN(rest::Transcoder transcoder, rest::Transcoder::make());
  HP_ASSIGN_OR_RETURN(std::string openapi, rest::openapi());
  HP_ASSIGN_OR_RETURN(StaticFiles files, StaticFiles::load(options.web_dir));
  impl.site.reset(new Site{options,
                           std::move(sources),
                           *impl.io,
                           Rpc(std::move(channel)),
                           std::move(transcoder),
                           std::move(openapi),
                           std::move(files),
                           {},
                           {}});
  impl.io->start([&impl](const std::shared_ptr<Socket>& socket) { impl.take(socket); });
  return made;
}

int Server::port() const { return impl_->io->port(); }

void Server::stop_accepting() { impl_->io->stop_accepting(); }

void Server::stop() {
  if (!impl_->site || std::exchange(impl_->is_stopped, true)) return;
  impl_->io->stop_accepting();
  impl_->site->connections.close_all();
  const bool all_ended = impl_->site->connections.wait_for_none(kStopPatience) &&
                         impl_->site->rpc.wait_for_none(kStopPatience);
  impl_->io->stop();
  // A call that the services have not ended would still call back: what it would find stays.
  if (!all_ended) static_cast<void>(impl_->io.release()), static_cast<void>(impl_->site.release());
}

}  // namespace hydroprint::http
