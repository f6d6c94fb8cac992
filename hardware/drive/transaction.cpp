#include "hardware/drive/transaction.h"

#include <fmt/format.h>

#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

#include "hardware/drive/connection.h"
#include "hardware/drive/serial_line.h"

namespace hydroprint::drive {
namespace {

using Clock = std::chrono::steady_clock;

std::size_t reply_bytes(const Request& request) {
  const bool is_read =
      request.function == Function::kReadHolding || request.function == Function::kReadInput;
  return is_read ? 3U + 2U * request.count : 6U;
}

}  // namespace

/// The line, and the order in which threads use it.
class Link::Line {
 public:
  Line(Endpoint endpoint, const LinkTiming& timing)
      : endpoint_(std::move(endpoint)), timing_(timing) {}

  [[nodiscard]] Status connect();
  void close();
  [[nodiscard]] bool is_open() const;
  [[nodiscard]] std::uint64_t connections() const;
  [[nodiscard]] Result<std::vector<std::uint16_t>> transact(const Request& request,
                                                            Urgency urgency);
  void distrust();

  [[nodiscard]] const Endpoint& endpoint() const { return endpoint_; }
  [[nodiscard]] const LinkTiming& timing() const { return timing_; }

 private:
  /// Holds exclusive use of the line during its lifetime.
  class Turn {
   public:
    Turn(Line& line, Urgency urgency);
    ~Turn();
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

   private:
    Line& line_;
  };

  void after_failure(bool lost);
  void drop();
  [[nodiscard]] tl::unexpected<Error> explain(Connection::End end, const std::string& cause) const;

  const Endpoint endpoint_;
  const LinkTiming timing_;
  mutable std::mutex mutex_;
  std::condition_variable free_;
  bool busy_ = false;
  int stops_waiting_ = 0;
  bool open_ = false;
  std::uint64_t connections_ = 0;
  Clock::time_point silent_until_;  // end of the silence after a failure; a stop does not wait
  Clock::time_point quiet_until_;   // end of the gap after a frame; every request waits
  std::unique_ptr<Connection> connection_;  // used only by the holder of the turn
};

Link::Line::Turn::Turn(Line& line, Urgency urgency) : line_(line) {
  std::unique_lock lock(line.mutex_);
  if (urgency == Urgency::kStop) {
    ++line.stops_waiting_;
    line.free_.wait(lock, [&] { return !line.busy_; });
    --line.stops_waiting_;
  } else {
    for (;;) {
      line.free_.wait(lock, [&] { return !line.busy_ && line.stops_waiting_ == 0; });
      if (Clock::now() >= line.silent_until_) break;
      const Clock::time_point until = line.silent_until_;
      line.free_.wait_until(lock, until);
    }
  }
  line.busy_ = true;
}

Link::Line::Turn::~Turn() {
  const std::scoped_lock lock(line_.mutex_);
  line_.busy_ = false;
  line_.free_.notify_all();
}

void Link::Line::drop() {
  connection_.reset();
  const std::scoped_lock lock(mutex_);
  open_ = false;
}

// On TCP a late reply is dropped with its connection. On a serial line, the delay has to be waited
// out.
void Link::Line::after_failure(bool lost) {
  if (lost || !endpoint_.serial) return drop();
  const std::scoped_lock lock(mutex_);
  silent_until_ = Clock::now() + timing_.worst_delay;
}

Status Link::Line::connect() {
  const Turn turn(*this, Urgency::kStop);
  drop();
  HP_ASSIGN_OR_RETURN(connection_, Connection::open(endpoint_, timing_));
  const std::scoped_lock lock(mutex_);
  open_ = true;
  ++connections_;
  return {};
}

void Link::Line::close() {
  const Turn turn(*this, Urgency::kStop);
  drop();
}

void Link::Line::distrust() {
  const Turn turn(*this, Urgency::kStop);
  after_failure(false);
}

bool Link::Line::is_open() const {
  const std::scoped_lock lock(mutex_);
  return open_;
}

std::uint64_t Link::Line::connections() const {
  const std::scoped_lock lock(mutex_);
  return connections_;
}

tl::unexpected<Error> Link::Line::explain(Connection::End end, const std::string& cause) const {
  const std::string where = fmt::format("drive at {}: ", endpoint_.text());
  switch (end) {
    case Connection::End::kTimeout: {
      Error error{Code::kUnavailable,
                  where + "no reply. Check power, cable and unit id",
                  "RIG_OFFLINE",
                  {{"timeout", "1"}}};
      return tl::unexpected(std::move(error));
    }
    case Connection::End::kDamaged:
      return fail(Code::kDataLoss,
                  fmt::format("{}damaged reply ({}). If this persists, check cable, termination, "
                              "baud rate and unit id",
                              where, cause),
                  "REPLY_INVALID");
    default:
      return fail(Code::kUnavailable,
                  fmt::format("{}connection lost ({}). Check cable and power", where, cause),
                  "RIG_OFFLINE");
  }
}

Result<std::vector<std::uint16_t>> Link::Line::transact(const Request& request, Urgency urgency) {
  const Turn turn(*this, urgency);
  if (!connection_) {
    return fail(Code::kUnavailable,
                fmt::format("drive at {}: not connected. Connect to it first", endpoint_.text()),
                "RIG_OFFLINE");
  }
  const Clock::time_point quiet_until = quiet_until_;
  if (endpoint_.serial) std::this_thread::sleep_until(quiet_until);
  std::vector<std::uint8_t> reply;
  std::string cause;
  const auto end = connection_->exchange(request.unit, encode_request(request),
                                         reply_bytes(request), reply, cause);
  if (endpoint_.serial) quiet_until_ = Clock::now() + frame_gap(endpoint_);
  if (end != Connection::End::kReply) {
    after_failure(end == Connection::End::kLost);
    return explain(end, cause);
  }
  auto words = decode_reply(request, reply);
  if (!words && words.error().reason == "REPLY_INVALID") after_failure(false);
  return words;
}

Link::Link(Endpoint endpoint, const LinkTiming& timing)
    : line_(std::make_unique<Line>(std::move(endpoint), timing)) {}
Link::~Link() = default;

Status Link::connect() { return line_->connect(); }
void Link::close() { line_->close(); }
bool Link::is_open() const { return line_->is_open(); }
std::uint64_t Link::connections() const { return line_->connections(); }
void Link::distrust() { line_->distrust(); }
const Endpoint& Link::endpoint() const { return line_->endpoint(); }
const LinkTiming& Link::timing() const { return line_->timing(); }

Result<std::vector<std::uint16_t>> Link::transact(const Request& request, Urgency urgency) {
  return line_->transact(request, urgency);
}

std::shared_ptr<Link> stop_link(const std::shared_ptr<Link>& link) {
  if (link->endpoint().serial) return link;
  return std::make_shared<Link>(link->endpoint(), link->timing());
}

}  // namespace hydroprint::drive
