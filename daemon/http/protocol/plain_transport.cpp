#include "daemon/http/protocol/plain_transport.h"

#include <sys/socket.h>

#include <cerrno>

namespace hydroprint::http {
namespace {

bool may_come_later() { return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR; }

class PlainTransport final : public Transport {
 public:
  explicit PlainTransport(int socket) : socket_(socket) {}

  Step open() override { return {Step::Outcome::kDone}; }
  Step read(char* into, std::size_t size) override { return receive(into, size, 0); }
  Step write(std::string_view bytes) override {
    const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent >= 0) return {Step::Outcome::kDone, static_cast<std::size_t>(sent)};
    return {may_come_later() ? Step::Outcome::kNeedsOutput : Step::Outcome::kOver};
  }
  Step look() override {
    char byte = 0;
    return receive(&byte, 1, MSG_PEEK);
  }
  [[nodiscard]] bool has_some() const override { return false; }
  void end() override { ::shutdown(socket_, SHUT_WR); }
  [[nodiscard]] bool is_secure() const override { return false; }

 private:
  Step receive(char* into, std::size_t size, int flags) const {
    const ssize_t got = ::recv(socket_, into, size, flags | MSG_DONTWAIT);
    if (got > 0) return {Step::Outcome::kDone, static_cast<std::size_t>(got)};
    return {got < 0 && may_come_later() ? Step::Outcome::kNeedsInput : Step::Outcome::kOver};
  }

  int socket_;
};

}  // namespace

std::unique_ptr<Transport> plain_transport(int socket) {
  return std::make_unique<PlainTransport>(socket);
}

}  // namespace hydroprint::http
