// Serves /healthz, /metrics and the web client's files.
#include "daemon/http/system_pages.h"

#include "daemon/http/error_response.h"
#include "daemon/http/protocol/async_value.h"

namespace hydroprint::http {
namespace {

constexpr milliseconds kSourcePatience{5000};
constexpr int kMaxBlockingTasks = 100;

/// Runs a blocking function on the blocking thread. Returns nullopt on timeout (for example, if the
/// disk does not respond), or if too many tasks wait for that thread.
template <class T>
Task<std::optional<T>> fetch_blocking(ServerContext& server, Exchange& exchange,
                                      std::function<T()> source) {
  if (server.blocking_tasks >= kMaxBlockingTasks) co_return std::nullopt;
  ++server.blocking_tasks;
  AsyncValue<T> async_value(exchange.shared_socket());
  server.listener.run_blocking([&server, source, receive = async_value.receiver()] {
    receive(source());
    --server.blocking_tasks;
  });
  const bool in_time = co_await async_value.wait(kSourcePatience);
  if (!in_time) co_return std::nullopt;
  co_return async_value.take();
}

}  // namespace

Task<std::string> answer_health(ServerContext& server, Exchange& exchange) {
  const std::optional<Health> health =
      co_await fetch_blocking<Health>(server, exchange, server.sources.health);
  if (!health) {
    co_await exchange.send(json_response(503, R"({"status":"bad","store":"does not answer"})"));
  } else {
    co_await exchange.send(json_response(health->is_good ? 200 : 503, health->json));
  }
  co_return "healthz";
}

Task<std::string> answer_metrics(ServerContext& server, Exchange& exchange) {
  std::optional<std::string> text =
      co_await fetch_blocking<std::string>(server, exchange, server.sources.metrics);
  // If the daemon's metrics are not available, the metrics of the HTTP server are still sent.
  Response response =
      text_response(200, text.value_or("") + server.metrics.text(server.connections.count()));
  response.fields.set("Content-Type", "text/plain; version=0.0.4; charset=utf-8");
  co_await exchange.send(std::move(response));
  co_return "metrics";
}

Task<std::string> answer_file(ServerContext& server, Exchange& exchange) {
  Response response = server.files.answer(exchange.head());
  if (response.status == 404) {
    response =
        refusal({Code::kNotFound, "no file exists at this path", ErrorReason::ROUTE_NOT_FOUND, {}});
  }
  co_await exchange.send(std::move(response));
  co_return "file";
}

}  // namespace hydroprint::http
