#include "daemon/http/protocol/tcp_listener.h"

#include <fmt/format.h>

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/strand.hpp>
#include <new>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "daemon/http/protocol/plain_transport.h"
#include "daemon/http/protocol/tls_transport.h"

namespace hydroprint::http {
namespace {

namespace asio = boost::asio;
using tcp = asio::ip::tcp;
using asio::error::operation_aborted;
using boost::system::error_code;
using Outcome = Step::Outcome;

constexpr int kThreads = 2;
constexpr milliseconds kDescriptorRetryDelay{100};
// Limits the data that the kernel buffers for a slow client.
constexpr int kSendBuffer_bytes = 256 << 10;

using Strand = asio::strand<asio::io_context::executor_type>;
using StrandSocket = asio::basic_stream_socket<tcp, Strand>;
using StrandTimer =
    asio::basic_waitable_timer<std::chrono::steady_clock,
                               asio::wait_traits<std::chrono::steady_clock>, Strand>;

std::string text_of(const tcp::endpoint& endpoint) {
  const std::string host = endpoint.address().to_string();
  return endpoint.address().is_v6() ? fmt::format("[{}]:{}", host, endpoint.port())
                                    : fmt::format("{}:{}", host, endpoint.port());
}

// The transport must not be used after the socket is closed, because its descriptor may then belong
// to another connection.
class TcpSocket final : public Socket, public std::enable_shared_from_this<TcpSocket> {
 public:
  TcpSocket(StrandSocket socket, const std::shared_ptr<const tls::Identity>& identity)
      : socket_(std::move(socket)),
        deadline_(socket_.get_executor()),
        wake_timer_(socket_.get_executor()) {
    error_code ignored;
    socket_.set_option(tcp::no_delay(true), ignored);
    socket_.set_option(asio::socket_base::send_buffer_size(kSendBuffer_bytes), ignored);
    socket_.non_blocking(true, ignored);
    peer_ = socket_.remote_endpoint(ignored).address().to_string();
    const int descriptor = socket_.native_handle();
    transport_ = identity ? tls_transport(descriptor, identity) : plain_transport(descriptor);
    if (!transport_) throw std::bad_alloc();
  }

  void open(milliseconds timeout, std::function<void(OpenResult)> done) override {
    begin(
        timeout, [this] { return transport_->open(); },
        [this, done = std::move(done)](Step step, bool) {
          const bool is_plain = step.outcome == Outcome::kPlainHttp;
          if (is_plain) transport_ = plain_transport(socket_.native_handle());
          const bool is_open = step.outcome == Outcome::kDone;
          done(is_open ? OpenResult::kYes : is_plain ? OpenResult::kPlainHttp : OpenResult::kNo);
        });
  }

  void when_readable(milliseconds timeout, std::function<void(bool)> done) override {
    begin(
        timeout,
        [this, waits = !transport_->has_some()]() mutable {
          return Step{std::exchange(waits, false) ? Outcome::kNeedsInput : Outcome::kDone};
        },
        [done = std::move(done)](Step, bool late) { done(!late); });
  }

  void read_some(char* into, std::size_t size, milliseconds timeout,
                 std::function<void(ReadResult)> done) override {
    begin(
        timeout, [this, into, size] { return transport_->read(into, size); },
        [done = std::move(done)](Step step, bool late) {
          done({step.outcome == Outcome::kDone ? step.bytes : 0, late});
        });
  }

  void write(std::string_view bytes, milliseconds timeout,
             std::function<void(bool)> done) override {
    begin(
        timeout,
        [this, left = bytes]() mutable {
          Step step{Outcome::kDone};
          while (!left.empty() && step.outcome == Outcome::kDone) {
            step = transport_->write(left);
            left.remove_prefix(step.bytes);
          }
          return step;
        },
        [done = std::move(done)](Step step, bool) { done(step.outcome == Outcome::kDone); });
  }

  void wait(milliseconds timeout, std::function<void(bool)> done) override {
    wake_timer_.expires_after(rings_ ? milliseconds(0) : timeout);
    wake_timer_.async_wait([self = shared_from_this(), done = std::move(done)](error_code) {
      done(std::exchange(self->rings_, false));
    });
  }

  void ring() override {
    rings_ = true;
    wake_timer_.cancel();
  }

  void watch(std::function<void()> gone) override {
    gone_ = std::move(gone);
    if (closed_) {
      post([self = shared_from_this()] { self->tell_gone(); });
      return;
    }
    watch_for(StrandSocket::wait_read, ++watch_);
  }

  void unwatch() override {
    ++watch_;
    gone_ = nullptr;
    error_code ignored;
    socket_.cancel(ignored);
  }

  void end_writing() override {
    if (!closed_) transport_->end();
  }

  void close() override {
    if (std::exchange(closed_, true)) return;
    error_code ignored;
    socket_.close(ignored);
    deadline_.cancel();
    wake_timer_.cancel();
    tell_gone();
  }

  [[nodiscard]] bool is_closed() const override { return closed_; }

  void post(std::function<void()> work) override {
    asio::post(socket_.get_executor(),
               [self = shared_from_this(), work = std::move(work)] { work(); });
  }

  [[nodiscard]] const std::string& peer() const override { return peer_; }
  [[nodiscard]] bool is_secure() const override { return transport_->is_secure(); }

 private:
  // An operation to retry whenever the socket is ready, and its callback.
  struct Operation {
    std::function<Step()> attempt;
    std::function<void(Step, bool)> done;  // the bool is true on timeout
  };

  void begin(milliseconds timeout, std::function<Step()> attempt,
             std::function<void(Step, bool)> done) {
    late_ = false;
    deadline_.expires_after(timeout);
    deadline_.async_wait([self = shared_from_this(), mine = ++operation_](error_code error) {
      if (error == operation_aborted || mine != self->operation_) return;
      self->late_ = true;
      error_code ignored;
      self->socket_.cancel(ignored);
    });
    proceed(std::make_shared<Operation>(Operation{std::move(attempt), std::move(done)}), true);
  }

  void proceed(const std::shared_ptr<Operation>& operation, bool is_first) {
    const Step step = closed_ ? Step{} : operation->attempt();
    if (step.outcome == Outcome::kNeedsInput || step.outcome == Outcome::kNeedsOutput) {
      socket_.async_wait(wait_type_for(step),
                         [self = shared_from_this(), operation](error_code error) {
                           error ? self->end(*operation, {}) : self->proceed(operation, false);
                         });
    } else if (is_first) {  // posted, because the callback must not precede the return
      post([self = shared_from_this(), operation, step] { self->end(*operation, step); });
    } else {
      end(*operation, step);
    }
  }

  void end(const Operation& operation, Step step) {
    ++operation_;
    deadline_.cancel();
    operation.done(step, late_);
  }

  static StrandSocket::wait_type wait_type_for(Step step) {
    return step.outcome == Outcome::kNeedsOutput ? StrandSocket::wait_write
                                                 : StrandSocket::wait_read;
  }

  void watch_for(StrandSocket::wait_type what, unsigned mine) {
    socket_.async_wait(what, [self = shared_from_this(), mine](error_code error) {
      if (error == operation_aborted || mine != self->watch_) return;
      const Step step = self->closed_ ? Step{} : self->transport_->look();
      if (step.outcome == Outcome::kOver) return self->tell_gone();
      if (step.outcome != Outcome::kDone) self->watch_for(wait_type_for(step), mine);
    });
  }

  void tell_gone() {
    if (const auto gone = std::exchange(gone_, nullptr)) gone();
  }

  StrandSocket socket_;
  std::unique_ptr<Transport> transport_;
  StrandTimer deadline_;  // timeout of the current operation
  StrandTimer wake_timer_;
  std::string peer_;
  std::function<void()> gone_;
  unsigned operation_ = 0, watch_ = 0;
  bool late_ = false, rings_ = false, closed_ = false;
};

}  // namespace

struct TcpListener::Impl {
  asio::io_context context{kThreads};
  asio::io_context waiting_context{1};
  asio::executor_work_guard<asio::io_context::executor_type> work{context.get_executor()};
  asio::executor_work_guard<asio::io_context::executor_type> waiting_work{
      waiting_context.get_executor()};
  Strand strand{context.get_executor()};  // strand of the listener
  asio::basic_socket_acceptor<tcp, Strand> acceptor{strand};
  StrandTimer retry_timer{strand};
  Accepted accepted;
  tls::CurrentIdentity identity;
  std::vector<std::thread> threads;

  [[nodiscard]] Status open(const std::string& host, int port) {
    error_code error;
    const tcp::endpoint endpoint(asio::ip::make_address(host, error),
                                 static_cast<unsigned short>(port));
    if (!error) acceptor.open(endpoint.protocol(), error);
    // Allows a port that was in use a moment ago, but not a port on which another program listens.
    if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor.bind(endpoint, error);
    if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
    if (!error) return {};
    const std::string why =
        error == asio::error::address_in_use
            ? "the port is in use, perhaps by another hydroprintd; stop that program or "
              "set another port with --http"
            : error.message() + "; set another address with --http";
    return fail(Code::kUnavailable,
                fmt::format("cannot listen at {}: {}",
                            text_of({endpoint.address(), endpoint.port()}), why));
  }

  void take(StrandSocket socket) {
    try {
      auto taken = std::make_shared<TcpSocket>(std::move(socket), identity ? identity() : nullptr);
      taken->post([this, taken] { accepted(taken); });
    } catch (const std::bad_alloc&) {  // the connection is closed; the client has to try again
    }
  }

  void accept() {
    acceptor.async_accept(asio::make_strand(context),
                          [this](error_code error, StrandSocket socket) {
                            if (error == operation_aborted || !acceptor.is_open()) return;
                            if (!error) {
                              take(std::move(socket));
                              return accept();
                            }
                            // Probably no descriptor is free until another connection ends.
                            retry_timer.expires_after(kDescriptorRetryDelay);
                            retry_timer.async_wait([this](error_code ended) {
                              if (!ended && acceptor.is_open()) accept();
                            });
                          });
  }
};

TcpListener::TcpListener() : impl_(std::make_unique<Impl>()) {}

TcpListener::~TcpListener() { stop(); }

Result<std::unique_ptr<TcpListener>> TcpListener::listen(const std::string& host, int port,
                                                         tls::CurrentIdentity identity) {
  std::unique_ptr<TcpListener> listener(new TcpListener);
  listener->impl_->identity = std::move(identity);
  HP_RETURN_IF_ERROR(listener->impl_->open(host, port));
  return listener;
}

int TcpListener::port() const {
  error_code ignored;
  return impl_->acceptor.local_endpoint(ignored).port();
}

void TcpListener::start(Accepted accepted) {
  impl_->accepted = std::move(accepted);
  asio::post(impl_->strand, [this] { impl_->accept(); });
  for (int i = 0; i < kThreads; ++i) {
    impl_->threads.emplace_back([this] { impl_->context.run(); });
  }
  impl_->threads.emplace_back([this] { impl_->waiting_context.run(); });
}

void TcpListener::stop_accepting() {
  asio::post(impl_->strand, [this] {
    error_code ignored;
    impl_->acceptor.close(ignored);
    impl_->retry_timer.cancel();
  });
}

void TcpListener::stop() {
  impl_->context.stop();
  impl_->waiting_context.stop();
  for (std::thread& thread : impl_->threads) thread.join();
  impl_->threads.clear();
}

void TcpListener::run_blocking(std::function<void()> work) {
  asio::post(impl_->waiting_context, std::move(work));
}

}  // namespace hydroprint::http
