#pragma once

#include <atomic>
#include <string>

#include "daemon/http/in_process_channel.h"
#include "daemon/http/protocol/connections.h"
#include "daemon/http/protocol/http_metrics.h"
#include "daemon/http/protocol/tcp_listener.h"
#include "daemon/http/server.h"
#include "daemon/http/static_files.h"
#include "daemon/rest/transcoder.h"

namespace hydroprint::http {

/// What all requests are answered from; outlives them.
struct ServerContext {
  Options options;
  Sources sources;
  TcpListener& listener;
  InProcessChannel rpc;
  rest::Transcoder transcoder;
  std::string openapi;
  StaticFiles files;
  Connections connections;
  HttpMetrics metrics;
  std::atomic<int> asides{0};  // what waits for the thread that may wait
};

}  // namespace hydroprint::http
