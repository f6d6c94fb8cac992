// Sends streams of the services as server-sent events.
#include "daemon/http/sse.h"

#include "daemon/http/error_response.h"
#include "daemon/http/protocol/async_value.h"
#include "daemon/http/sse_text.h"
#include "daemon/rest/answer.h"

namespace hydroprint::http {
namespace {

constexpr milliseconds kEndPatience{5000};  // time for a cancelled call to end

Response event_stream() {
  Response response;
  response.fields.set("Content-Type", "text/event-stream");
  // Reverse proxies such as nginx collect a response before they pass it on, unless they see this.
  response.fields.set("X-Accel-Buffering", "no");
  return response;
}

/// One stream to one client. Each message is requested after the previous message was sent, so a
/// client that does not read occupies only one message and the kernel's buffer.
class EventStream {
 public:
  EventStream(ServerContext& server, Exchange& exchange, rest::Call request,
              const InProcessChannel::Metadata& metadata)
      : server_(server),
        exchange_(exchange),
        request_(std::move(request)),
        stream_(server.rpc.stream(request_.method, metadata)),
        message_(exchange.shared_socket()) {}

  Task<void> run() {
    co_await ask();
    exchange_.socket().watch([gone = gone_, socket = &exchange_.socket()] {
      *gone = true;
      socket->ring();
    });
    for (bool is_open = true; is_open;) is_open = co_await forward_event();
    // No write is in progress here, as unwatch() requires.
    exchange_.socket().unwatch();
    if (*gone_) exchange_.break_off();
  }

 private:
  // Sends the request. The first read shows whether the service accepted the request.
  Task<void> ask() {
    AsyncValue<bool> written(exchange_.shared_socket());
    stream_->write(request_.request, true, written.receiver());
    co_await written.wait(kEndPatience);
  }

  // Forwards one message; returns false if the stream has ended.
  Task<bool> forward_event() {
    stream_->read(message_.receiver());
    for (;;) {
      const bool in_time = co_await wait_for_message();
      if (*gone_) co_return false;
      if (in_time) break;
      const bool lives = co_await send(": ping\n\n");
      if (!lives) co_return false;
    }
    const std::optional<std::string> message = message_.take();
    if (!message) {
      co_await end();
      co_return false;
    }
    co_return co_await send(text_of(*message));
  }

  Task<bool> wait_for_message() {
    const auto end = std::chrono::steady_clock::now() + exchange_.limits().ping_time;
    while (!message_.is_here() && !*gone_) {
      const auto left =
          std::chrono::duration_cast<milliseconds>(end - std::chrono::steady_clock::now());
      if (left.count() <= 0) co_return false;
      co_await exchange_.socket().rung(left);
    }
    co_return message_.is_here();
  }

  std::string text_of(const std::string& message) {
    const Result<std::string> json = server_.transcoder.write(request_.method, message);
    if (!json) return event_text("", "error", refusal(json.error()).body);
    return event_text(server_.transcoder.event_id(request_.method, message),
                      event_kind(request_.method, message), *json);
  }

  Task<bool> send(std::string text) {
    if (exchange_.status() == 0) {
      const bool begun = co_await exchange_.begin_answer(event_stream(), std::nullopt);
      if (!begun) co_return false;
    }
    co_return co_await exchange_.write(std::move(text));
  }

  // An error before the first message is sent as an ordinary error response.
  Task<void> end() {
    AsyncValue<Reply> async_value(exchange_.shared_socket());
    stream_->finish(async_value.receiver());
    const bool in_time = co_await async_value.wait(kEndPatience);
    const Reply reply =
        in_time ? async_value.take() : Reply{14, "the stream ended unexpectedly", "", ""};
    if (!reply.ok() && exchange_.status() == 0) {
      co_await exchange_.send(refusal(reply));
      co_return;
    }
    std::string last = event_text("", "end", "{}");
    if (!reply.ok()) last = event_text("", "error", refusal(reply).body);
    co_await send(std::move(last));
    co_await exchange_.end_answer();
  }

  ServerContext& server_;
  Exchange& exchange_;
  rest::Call request_;
  std::unique_ptr<Stream> stream_;
  AsyncValue<std::optional<std::string>> message_;
  std::shared_ptr<bool> gone_ = std::make_shared<bool>(false);
};

}  // namespace

Task<void> answer_events(ServerContext& server, Exchange& exchange, rest::Call request,
                         InProcessChannel::Metadata metadata) {
  EventStream stream(server, exchange, std::move(request), metadata);
  co_await stream.run();
}

}  // namespace hydroprint::http
