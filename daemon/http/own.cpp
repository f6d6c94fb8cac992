// What the server says of itself and of the daemon, and the web client's files.
#include "daemon/http/site.h"
#include "daemon/http/waiting.h"

namespace hydroprint::http {
namespace {

constexpr milliseconds kSourcePatience{5000};
constexpr int kMostAsides = 100;

/// Has another thread do what may take its time: nothing if that takes too long, as it does when
/// the disk hangs.
template <class T>
Task<std::optional<T>> ask_aside(Site& site, Exchange& exchange, std::function<T()> source) {
  if (site.asides >= kMostAsides) co_return std::nullopt;
  ++site.asides;
  Coming<T> coming(exchange.shared_socket());
  site.io.aside([&site, source, receive = coming.receiver()] {
    receive(source());
    --site.asides;
  });
  const bool came = co_await coming.wait(kSourcePatience);
  if (!came) co_return std::nullopt;
  co_return coming.take();
}

}  // namespace

Task<std::string> answer_health(Site& site, Exchange& exchange) {
  const std::optional<Health> health =
      co_await ask_aside<Health>(site, exchange, site.sources.health);
  if (!health) {
    co_await exchange.send(json_response(503, R"({"status":"bad","store":"does not answer"})"));
  } else {
    co_await exchange.send(json_response(health->is_good ? 200 : 503, health->json));
  }
  co_return "healthz";
}

Task<std::string> answer_metrics(Site& site, Exchange& exchange) {
  std::optional<std::string> text =
      co_await ask_aside<std::string>(site, exchange, site.sources.metrics);
  // Without the store's figures there are still the server's own.
  Response response =
      text_response(200, text.value_or("") + site.counters.text(site.connections.count()));
  response.fields.set("Content-Type", "text/plain; version=0.0.4; charset=utf-8");
  co_await exchange.send(std::move(response));
  co_return "metrics";
}

Task<std::string> answer_file(Site& site, Exchange& exchange) {
  Response response = site.files.answer(exchange.head());
  if (response.status == 404) {
    response = refusal({Code::kNotFound, "there is no such file", "ROUTE_NOT_FOUND", {}});
  }
  co_await exchange.send(std::move(response));
  co_return "file";
}

}  // namespace hydroprint::http
