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

/// State shared by all requests; outlives them.
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
  std::atomic<int> blocking_tasks{0};  // number of tasks queued or running on the blocking thread
};

}  // namespace hydroprint::http
