#include "hardware/printer/exchange.h"

#include <fmt/format.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <string>

#include "sim/base/process/periodic_thread.h"

namespace hydroprint::printer {
namespace {

using std::chrono::milliseconds;

struct HttpClose {
  void operator()(http_t* http) const { httpClose(http); }
};
using Http = std::unique_ptr<http_t, HttpClose>;

/// Closes a connection when its time is up or the caller cancels. CUPS limits each wait, but not
/// their number.
class Deadline {
 public:
  using Clock = std::chrono::steady_clock;

  Deadline(int socket, milliseconds after, const std::function<bool()>& gives_up)
      : thread_(kLookEvery, [this, socket, end = Clock::now() + after, &gives_up] {
          has_passed_ = Clock::now() >= end;
          given_up_ = given_up_ || (!has_passed_ && gives_up && gives_up());
          if (has_passed_ || given_up_) ::shutdown(socket, SHUT_RDWR);
        }) {}

  [[nodiscard]] bool has_passed() const { return has_passed_; }
  [[nodiscard]] bool given_up() const { return given_up_; }

 private:
  static constexpr milliseconds kLookEvery{100};
  std::atomic<bool> has_passed_ = false, given_up_ = false;
  PeriodicThread thread_;  // last member: it uses the others
};

/// Called by CUPS when the time for one wait is up. Returns 0, so that CUPS stops waiting.
int give_up(http_t*, void* timed_out) {
  *static_cast<bool*>(timed_out) = true;
  return 0;
}

/// One connection and its state.
class Connection {
 public:
  Connection(const Address& address, const ExchangeTiming& timing,
             const std::function<bool()>& gives_up)
      : address_(address), timing_(timing), gives_up_(gives_up) {
    if (gives_up_ && gives_up_()) return;
    http_.reset(
        httpConnect2(address.host.c_str(), address.port, nullptr, AF_UNSPEC,
                     address.encrypted ? HTTP_ENCRYPTION_ALWAYS : HTTP_ENCRYPTION_IF_REQUESTED, 1,
                     static_cast<int>(timing.connect.count()), nullptr));
  }

  [[nodiscard]] Result<Ipp> exchange(ipp_t* request, std::span<const unsigned char> document) {
    if (gives_up_ && gives_up_()) return left();
    if (!http_)
      return failure(ErrorReason::PRINTER_UNREACHABLE,
                     "cannot be reached. Check its power and the address");
    const double wait_s = std::chrono::duration<double>(timing_.answer).count();
    httpSetTimeout(http_.get(), wait_s, give_up, &timed_out_);
    Deadline deadline(httpGetFd(http_.get()), timing_.whole, gives_up_);
    // A printer that rejects a request may respond and disconnect before it has received
    // everything.
    const bool is_sent = send(request, document);
    Ipp reply(ippNew());
    http_status_t status = HTTP_STATUS_CONTINUE;
    while (status == HTTP_STATUS_CONTINUE) status = httpUpdate(http_.get());
    if (status == HTTP_STATUS_ERROR) return broken(deadline, is_sent);
    if (status != HTTP_STATUS_OK) {
      return failure(
          ErrorReason::PRINTER_NOT_IPP,
          fmt::format("responds \"{}\". Check the address's path, as in ipp://HOST/ipp/print",
                      httpStatus(status)));
    }
    ipp_state_t state = IPP_STATE_IDLE;
    while (state != IPP_STATE_DATA && state != IPP_STATE_ERROR) {
      state = ippRead(http_.get(), reply.get());
    }
    if (state == IPP_STATE_DATA) return reply;
    if (timed_out_ || deadline.has_passed() || deadline.given_up() || httpError(http_.get()) != 0) {
      return broken(deadline, is_sent);
    }
    return failure(ErrorReason::PRINTER_NOT_IPP, "does not respond with IPP. Check the address");
  }

 private:
  [[nodiscard]] bool send(ipp_t* request, std::span<const unsigned char> document) {
    http_t* http = http_.get();
    httpClearFields(http);
    httpSetField(http, HTTP_FIELD_CONTENT_TYPE, "application/ipp");
    httpSetLength(http, ippLength(request) + document.size());
    if (httpPost(http, address_.resource.c_str()) != 0) return false;
    ippSetState(request, IPP_STATE_IDLE);
    ipp_state_t state = IPP_STATE_IDLE;
    while (state != IPP_STATE_DATA) {
      state = ippWrite(http, request);
      if (state == IPP_STATE_ERROR) return false;
    }
    return send(document);
  }
  [[nodiscard]] bool send(std::span<const unsigned char> document) {
    constexpr std::size_t kPart = 65536;
    while (!document.empty()) {
      const auto part = document.first(std::min(kPart, document.size()));
      const ssize_t written =
          httpWrite2(http_.get(), reinterpret_cast<const char*>(part.data()), part.size());
      if (written <= 0) return false;
      document = document.subspan(static_cast<std::size_t>(written));
      if (httpWait(http_.get(), 0) != 0) return document.empty();  // the reply has already arrived
    }
    return httpFlushWrite(http_.get()) >= 0;
  }

  [[nodiscard]] tl::unexpected<Error> failure(ErrorReason reason, const std::string& what) const {
    return fail(Code::kUnavailable, "printer " + address_.uri + ": " + what, reason);
  }
  [[nodiscard]] tl::unexpected<Error> left() const {
    return fail(Code::kCancelled, "printer " + address_.uri + ": cancelled",
                ErrorReason::CANCELLED);
  }
  [[nodiscard]] tl::unexpected<Error> broken(const Deadline& deadline, bool is_sent) const {
    if (deadline.given_up()) return left();
    if (timed_out_ || deadline.has_passed()) {
      return failure(ErrorReason::PRINTER_SILENT,
                     is_sent ? "does not respond in time. Check its display"
                             : "does not accept the data in time. Check its display");
    }
    return failure(ErrorReason::PRINTER_LOST, "closed the connection. Check its power");
  }

  const Address& address_;
  const ExchangeTiming& timing_;
  const std::function<bool()>& gives_up_;
  Http http_;
  bool timed_out_ = false;
};

}  // namespace

Result<Ipp> exchange(const Address& address, const ExchangeTiming& timing,
                     const std::function<bool()>& gives_up, ipp_t* request,
                     std::span<const unsigned char> document) {
  return Connection(address, timing, gives_up).exchange(request, document);
}

}  // namespace hydroprint::printer
