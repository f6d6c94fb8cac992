#include "daemon/http/io.h"

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/strand.hpp>
#include <boost/asio/write.hpp>
#include <optional>
#include <thread>
#include <utility>  // Asio 1.74 does not include what it needs
#include <vector>

namespace hydroprint::http {
namespace {

namespace asio = boost::asio;
using tcp = asio::ip::tcp;
using asio::error::operation_aborted;
using boost::system::error_code;

constexpr int kThreads = 2;
constexpr milliseconds kNapWithoutDescriptors{100};
// What a reader that does not read may have waiting in the kernel.
constexpr int kSendBuffer_bytes = 256 << 10;

using Strand = asio::strand<asio::io_context::executor_type>;
using StrandSocket = asio::basic_stream_socket<tcp, Strand>;
using StrandTimer =
    asio::basic_waitable_timer<std::chrono::steady_clock,
                               asio::wait_traits<std::chrono::steady_clock>, Strand>;

std::string text_of(const tcp::endpoint& endpoint) {
  const std::string host = endpoint.address().to_string();
  return (endpoint.address().is_v6() ? "[" + host + "]" : host) + ":" +
         std::to_string(endpoint.port());
}

class TcpSocket final : public Socket, public std::enable_shared_from_this<TcpSocket> {
 public:
  explicit TcpSocket(StrandSocket socket)
      : socket_(std::move(socket)),
        deadline_(socket_.get_executor()),
        bell_(socket_.get_executor()) {
    error_code ignored;
    socket_.set_option(tcp::no_delay(true), ignored);
    socket_.set_option(asio::socket_base::send_buffer_size(kSendBuffer_bytes), ignored);
    socket_.non_blocking(true, ignored);
    peer_ = socket_.remote_endpoint(ignored).address().to_string();
  }

  void when_readable(milliseconds timeout, std::function<void(bool)> done) override {
    begin(timeout);
    socket_.async_wait(StrandSocket::wait_read, [self = shared_from_this(), done = std::move(done)](
                                                    error_code) { done(!self->ended_late()); });
  }

  void read_some(char* into, std::size_t size, milliseconds timeout,
                 std::function<void(Got)> done) override {
    begin(timeout);
    socket_.async_read_some(
        asio::buffer(into, size),
        [self = shared_from_this(), done = std::move(done)](error_code error, std::size_t bytes) {
          const bool late = self->ended_late();
          done({error ? 0 : bytes, late});
        });
  }

  void write(std::string_view bytes, milliseconds timeout,
             std::function<void(bool)> done) override {
    begin(timeout);
    asio::async_write(
        socket_, asio::buffer(bytes.data(), bytes.size()),
        [self = shared_from_this(), done = std::move(done)](error_code error, std::size_t) {
          self->ended_late();
          done(!error);
        });
  }

  void wait(milliseconds timeout, std::function<void(bool)> done) override {
    bell_.expires_after(rings_ ? milliseconds(0) : timeout);
    bell_.async_wait([self = shared_from_this(), done = std::move(done)](error_code) {
      done(std::exchange(self->rings_, false));
    });
  }

  void ring() override {
    rings_ = true;
    bell_.cancel();
  }

  void watch(std::function<void()> gone) override {
    gone_ = std::move(gone);
    if (closed_) {
      post([self = shared_from_this()] { self->tell_gone(); });
      return;
    }
    socket_.async_wait(StrandSocket::wait_read,
                       [self = shared_from_this(), mine = ++watch_](error_code error) {
                         if (error != operation_aborted && mine == self->watch_)
                           self->look_for_end();
                       });
  }

  void unwatch() override {
    ++watch_;
    gone_ = nullptr;
    error_code ignored;
    socket_.cancel(ignored);
  }

  void end_writing() override {
    error_code ignored;
    socket_.shutdown(StrandSocket::shutdown_send, ignored);
  }

  void close() override {
    if (std::exchange(closed_, true)) return;
    error_code ignored;
    socket_.close(ignored);
    deadline_.cancel();
    bell_.cancel();
    tell_gone();
  }

  [[nodiscard]] bool is_closed() const override { return closed_; }

  void post(std::function<void()> work) override {
    asio::post(socket_.get_executor(),
               [self = shared_from_this(), work = std::move(work)] { work(); });
  }

  [[nodiscard]] const std::string& peer() const override { return peer_; }

 private:
  void begin(milliseconds timeout) {
    late_ = false;
    deadline_.expires_after(timeout);
    deadline_.async_wait([self = shared_from_this(), mine = ++operation_](error_code error) {
      if (error == operation_aborted || mine != self->operation_) return;
      self->late_ = true;
      error_code ignored;
      self->socket_.cancel(ignored);
    });
  }

  bool ended_late() {
    ++operation_;
    deadline_.cancel();
    return late_;
  }

  void look_for_end() {
    char byte = 0;
    error_code error;
    const std::size_t got =
        socket_.receive(asio::buffer(&byte, 1), StrandSocket::message_peek, error);
    const bool there_is_more = !error && got > 0;
    if (!there_is_more && error != asio::error::would_block) tell_gone();
  }

  void tell_gone() {
    if (const auto gone = std::exchange(gone_, nullptr)) gone();
  }

  StrandSocket socket_;
  StrandTimer deadline_;  // of what is read or written
  StrandTimer bell_;
  std::string peer_;
  std::function<void()> gone_;
  unsigned operation_ = 0, watch_ = 0;
  bool late_ = false, rings_ = false, closed_ = false;
};

}  // namespace

struct Io::Impl {
  asio::io_context context{kThreads};
  asio::io_context waiting_context{1};
  asio::executor_work_guard<asio::io_context::executor_type> work{context.get_executor()};
  asio::executor_work_guard<asio::io_context::executor_type> waiting_work{
      waiting_context.get_executor()};
  Strand strand{context.get_executor()};  // the listener's
  asio::basic_socket_acceptor<tcp, Strand> acceptor{strand};
  StrandTimer nap{strand};
  Accepted accepted;
  std::vector<std::thread> threads;

  [[nodiscard]] Status open(const std::string& host, int port) {
    error_code error;
    const tcp::endpoint endpoint(asio::ip::make_address(host, error),
                                 static_cast<unsigned short>(port));
    if (!error) acceptor.open(endpoint.protocol(), error);
    // A port that was left a moment ago; one that somebody listens at is refused all the same.
    if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor.bind(endpoint, error);
    if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
    if (!error) return {};
    const std::string why = error == asio::error::address_in_use
                                ? "something else does, perhaps another hydroprintd; stop that or "
                                  "give another port with --http"
                                : error.message() + "; give another address with --http";
    return fail(Code::kUnavailable,
                "cannot listen at " + text_of({endpoint.address(), endpoint.port()}) + ": " + why);
  }

  void accept() {
    acceptor.async_accept(asio::make_strand(context),
                          [this](error_code error, StrandSocket socket) {
                            if (error == operation_aborted || !acceptor.is_open()) return;
                            if (!error) {
                              auto taken = std::make_shared<TcpSocket>(std::move(socket));
                              taken->post([this, taken] { accepted(taken); });
                              return accept();
                            }
                            // No descriptor is free: some connection has to end first.
                            nap.expires_after(kNapWithoutDescriptors);
                            nap.async_wait([this](error_code ended) {
                              if (!ended && acceptor.is_open()) accept();
                            });
                          });
  }
};

Io::Io() : impl_(std::make_unique<Impl>()) {}

Io::~Io() { stop(); }

Result<std::unique_ptr<Io>> Io::listen(const std::string& host, int port) {
  std::unique_ptr<Io> made(new Io);
  HP_RETURN_IF_ERROR(made->impl_->open(host, port));
  return made;
}

int Io::port() const {
  error_code ignored;
  return impl_->acceptor.local_endpoint(ignored).port();
}

void Io::start(Accepted accepted) {
  impl_->accepted = std::move(accepted);
  asio::post(impl_->strand, [this] { impl_->accept(); });
  for (int i = 0; i < kThreads; ++i) {
    impl_->threads.emplace_back([this] { impl_->context.run(); });
  }
  impl_->threads.emplace_back([this] { impl_->waiting_context.run(); });
}

void Io::stop_accepting() {
  asio::post(impl_->strand, [this] {
    error_code ignored;
    impl_->acceptor.close(ignored);
    impl_->nap.cancel();
  });
}

void Io::stop() {
  impl_->context.stop();
  impl_->waiting_context.stop();
  for (std::thread& thread : impl_->threads) thread.join();
  impl_->threads.clear();
}

void Io::aside(std::function<void()> work) { asio::post(impl_->waiting_context, std::move(work)); }

}  // namespace hydroprint::http
