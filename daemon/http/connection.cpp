// Serves one connection, from its first request to its end.
#include "daemon/http/connection.h"

#include <chrono>

#include "daemon/http/error_response.h"
#include "daemon/http/router.h"

namespace hydroprint::http {
namespace {

constexpr milliseconds kLinger{1000};
constexpr std::size_t kMaxLinger_bytes = 1 << 20;

// Reads and discards the rest of the client's data. Otherwise the kernel would reset the connection
// and discard a response that the client has not yet read.
Task<void> close_gracefully(Socket& socket) {
  socket.end_writing();
  std::string dropped(16 << 10, '\0');
  for (std::size_t taken = 0; taken < kMaxLinger_bytes;) {
    const Socket::ReadResult got = co_await socket.read(dropped.data(), dropped.size(), kLinger);
    if (got.bytes == 0) break;
    taken += got.bytes;
  }
  socket.close();
}

Response refused_head(Exchange::BeginResult begin_result) {
  switch (begin_result) {
    case Exchange::BeginResult::kHeaderTooLarge:
      return refusal({Code::kOutOfRange,
                      "the header is too long; send fewer or shorter header fields",
                      ErrorReason::HEADER_TOO_LARGE,
                      {}},
                     431);
    case Exchange::BeginResult::kTimedOut:
      return refusal({Code::kCancelled,
                      "the request did not arrive in time; send it again",
                      ErrorReason::REQUEST_TIMED_OUT,
                      {}},
                     408);
    default:
      return refusal({Code::kInvalidArgument,
                      "the request line or header is not valid HTTP/1.1; correct the request",
                      ErrorReason::REQUEST_MALFORMED,
                      {}},
                     400);
  }
}

// Sends the last response on the connection.
Task<bool> send_last(Socket& socket, Response response, milliseconds timeout) {
  const std::string text =
      head_text(response, Head{}, {response.body.size(), false, socket.is_secure()}) +
      response.body;
  co_return co_await socket.written(text, timeout);
}

// Serves one request; returns whether another may follow on the connection.
Task<bool> serve_one(ServerContext& server, const std::shared_ptr<Socket>& socket,
                     std::string& buffered, bool is_first) {
  Exchange exchange(socket, server.options.limits, buffered);
  const Exchange::BeginResult begin_result = co_await exchange.begin_request(is_first);
  if (begin_result == Exchange::BeginResult::kGone) co_return false;
  if (begin_result != Exchange::BeginResult::kYes) {
    // The connection cannot continue, because the start of the next request is unknown.
    Response response = refused_head(begin_result);
    server.metrics.count_request("unreadable", "", response.status);
    co_await send_last(*socket, std::move(response), server.options.limits.write_time);
    co_return false;
  }
  const auto start = std::chrono::steady_clock::now();
  const std::string route = co_await answer(server, exchange);
  server.metrics.count_request(route, exchange.head().method, exchange.status());
  server.metrics.observe_duration(route, std::chrono::steady_clock::now() - start);
  co_return co_await exchange.end_request();
}

// Performs the TLS handshake. A client that does not use TLS gets an error in plain HTTP.
Task<bool> open_connection(Socket& socket, milliseconds timeout) {
  const Socket::OpenResult open_result = co_await socket.opened(timeout);
  if (open_result == Socket::OpenResult::kPlainHttp) {
    Response response =
        refusal({Code::kInvalidArgument,
                 "this port uses TLS; write https:// instead of http:// in the address",
                 ErrorReason::REQUEST_MALFORMED,
                 {}});
    const bool is_sent = co_await send_last(socket, std::move(response), kLinger);
    if (is_sent) co_await close_gracefully(socket);
  }
  if (open_result != Socket::OpenResult::kYes) socket.close();
  co_return open_result == Socket::OpenResult::kYes;
}

Task<void> serve_all(ServerContext& server, std::shared_ptr<Socket> socket) {
  const bool is_open = co_await open_connection(*socket, server.options.limits.header_time);
  if (!is_open) co_return;
  std::string buffered;
  for (bool is_first = true;; is_first = false) {
    const bool keep_alive = co_await serve_one(server, socket, buffered, is_first);
    if (!keep_alive) break;
  }
  if (!socket->is_closed()) co_await close_gracefully(*socket);
}

Task<void> say_full(Socket& socket) {
  const bool is_open = co_await open_connection(socket, kLinger);
  if (!is_open) co_return;
  Response response = refusal({Code::kUnavailable,
                               "too many connections are open; try again in a moment",
                               ErrorReason::CONNECTIONS_FULL,
                               {}});
  response.fields.set("Retry-After", "5");
  const bool is_sent = co_await send_last(socket, std::move(response), kLinger);
  if (is_sent) co_await close_gracefully(socket);
}

}  // namespace

Detached serve(ServerContext& server, std::shared_ptr<Socket> socket) {
  try {
    co_await serve_all(server, socket);
  } catch (const std::exception&) {  // out of memory
    socket->close();
  }
  server.connections.remove(socket);
}

Detached turn_away(ServerContext& server, std::shared_ptr<Socket> socket) {
  server.metrics.count_refused_connection();
  try {
    co_await say_full(*socket);
  } catch (const std::exception&) {  // out of memory
  }
  socket->close();
  server.connections.remove(socket);
}

}  // namespace hydroprint::http
