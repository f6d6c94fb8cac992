#include "hardware/drive/transaction.h"

#include <fmt/format.h>

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

#include "hardware/drive/connection.h"
#include "hardware/drive/late_replies.h"
#include "hardware/drive/serial_line.h"

namespace hydroprint::drive {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kChecksum = 2;  // bytes

/// Number of bytes of request, echo and reply on a serial line.
std::size_t bytes_on_line(const Request& request, const BusVariant& bus) {
  const std::size_t sent = encode_request(request).size() + kChecksum;
  const std::size_t reply = (is_read(request) ? 3U + 2U * request.count : 6U) + kChecksum;
  return (bus.echo ? 2 : 1) * sent + reply;
}

}  // namespace

/// The line, and the order in which threads use it.
class Link::Line {
 public:
  Line(Endpoint endpoint, const LinkTiming& timing)
      : endpoint_(std::move(endpoint)),
        timing_(timing),
        framing_(endpoint_.serial || timing.bus.rtu_over_tcp ? Framing::kRtu : Framing::kTcp) {}

  [[nodiscard]] Status connect();
  void close();
  [[nodiscard]] bool is_open() const;
  [[nodiscard]] std::uint64_t connections() const;
  [[nodiscard]] Result<std::vector<std::uint16_t>> transact(const Request& request,
                                                            Urgency urgency);
  void distrust(const Request& request);
  [[nodiscard]] bool may_be_confused(const Request& request) const;

  [[nodiscard]] const Endpoint& endpoint() const { return endpoint_; }
  [[nodiscard]] const LinkTiming& timing() const { return timing_; }
  [[nodiscard]] LinkCounters& counters() { return counters_; }

 private:
  /// Holds exclusive use of the line during its lifetime.
  class Turn {
   public:
    Turn(Line& line, Urgency urgency, const Request* request = nullptr);
    ~Turn();
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

   private:
    Line& line_;
  };

  using Words = std::vector<std::uint16_t>;

  [[nodiscard]] Clock::time_point quiet_for(const Request& request) const;
  [[nodiscard]] std::chrono::nanoseconds patience(const Request& request) const;
  [[nodiscard]] Result<Words> after_reply(const Request& request, bool is_ambiguous,
                                          Result<Words> reply);
  void after_failure(Connection::End end, const Request& request, Urgency urgency);
  void expect_late_reply(const Request& request);
  void drop();
  [[nodiscard]] tl::unexpected<Error> explain(Connection::End end, const Request& request,
                                              const std::string& cause) const;

  const Endpoint endpoint_;
  const LinkTiming timing_;
  const Framing framing_;
  LinkCounters counters_;
  mutable std::mutex mutex_;
  std::condition_variable free_;
  bool busy_ = false;
  int stops_waiting_ = 0;
  bool open_ = false;
  std::uint64_t connections_ = 0;
  LateReplies late_;                // a stop does not wait for them
  Clock::time_point silent_until_;  // end of the silence after a failure; a stop does not wait
  // Used only by the holder of the turn.
  Clock::time_point quiet_until_;  // end of the gap after a frame; every request waits
  std::uint16_t transaction_ = 0;
  std::unique_ptr<Connection> connection_;
};

Link::Line::Turn::Turn(Line& line, Urgency urgency, const Request* request) : line_(line) {
  std::unique_lock lock(line.mutex_);
  if (urgency == Urgency::kStop) {
    ++line.stops_waiting_;
    line.free_.wait(lock, [&] { return !line.busy_; });
    --line.stops_waiting_;
  } else {
    for (;;) {
      line.free_.wait(lock, [&] { return !line.busy_ && line.stops_waiting_ == 0; });
      const Clock::time_point until = line.quiet_for(*request);
      if (Clock::now() >= until) break;
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

/// Returns when an ordinary request may be sent. RTU has no transaction ids: until the worst delay
/// is over, no request is sent whose reply could be confused with a missing one, and if the drive
/// requires it, no request at all. Needs the lock.
Clock::time_point Link::Line::quiet_for(const Request& request) const {
  if (framing_ == Framing::kTcp) return {};
  return std::max(silent_until_, late_.clear_for(request));
}

void Link::Line::expect_late_reply(const Request& request) {
  const Clock::time_point until = Clock::now() + timing_.worst_delay;
  const std::scoped_lock lock(mutex_);
  late_.add(request, until);
  if (timing_.bus.silence_after_bad_reply) silent_until_ = until;
}

// A stop that times out reconnects, because a connection that lost packets may delay the next.
void Link::Line::after_failure(Connection::End end, const Request& request, Urgency urgency) {
  if (end == Connection::End::kTimeout) counters_.add_unanswered();
  if (end == Connection::End::kDamaged) counters_.add_damaged(1);
  expect_late_reply(request);
  if (end == Connection::End::kLost || (urgency == Urgency::kStop && !endpoint_.serial)) drop();
}

/// A drive replies in the order of the requests, so after a valid reply no request waits for late
/// ones, unless this one may itself be late: a stop does not wait, and exceptions to reads look
/// alike.
Result<std::vector<std::uint16_t>> Link::Line::after_reply(const Request& request,
                                                           bool is_ambiguous, Result<Words> reply) {
  {
    const std::scoped_lock lock(mutex_);
    is_ambiguous = is_ambiguous || (!reply && late_.expects_any(Clock::now()));
    if (!is_ambiguous) late_.pass_over();
  }
  if (is_ambiguous) expect_late_reply(request);
  return reply;
}

Status Link::Line::connect() {
  const Turn turn(*this, Urgency::kStop);
  drop();
  HP_ASSIGN_OR_RETURN(connection_, Connection::open(endpoint_, timing_));
  const std::scoped_lock lock(mutex_);
  open_ = true;
  ++connections_;
  if (framing_ == Framing::kTcp) late_.clear();
  return {};
}

void Link::Line::close() {
  const Turn turn(*this, Urgency::kStop);
  drop();
}

void Link::Line::distrust(const Request& request) {
  counters_.add_damaged(1);
  expect_late_reply(request);
}

bool Link::Line::may_be_confused(const Request& request) const {
  const std::scoped_lock lock(mutex_);
  return framing_ == Framing::kRtu && late_.may_be_confused(request, Clock::now());
}

bool Link::Line::is_open() const {
  const std::scoped_lock lock(mutex_);
  return open_;
}

std::uint64_t Link::Line::connections() const {
  const std::scoped_lock lock(mutex_);
  return connections_;
}

tl::unexpected<Error> Link::Line::explain(Connection::End end, const Request& request,
                                          const std::string& cause) const {
  const std::string where = fmt::format("drive at {}: ", endpoint_.text());
  Error error{Code::kUnavailable, "", ErrorReason::RIG_OFFLINE, {}};
  switch (end) {
    case Connection::End::kTimeout:
      error.message = where + "no reply. Check power, cable and unit id";
      break;
    case Connection::End::kDamaged:
      error = {Code::kDataLoss, where + cause, ErrorReason::REPLY_INVALID, {}};
      break;
    case Connection::End::kEcho:
      error.message = where +
                      "the RS-485 adapter sends every request back (echo). Switch its echo "
                      "off, or set echo = true in the drive's profile";
      return tl::unexpected(std::move(error));
    default:
      error.message = fmt::format("{}connection lost ({}). Check cable and power", where, cause);
      return tl::unexpected(std::move(error));
  }
  if (end == Connection::End::kTimeout || !is_read(request)) error.metadata["timeout"] = "1";
  return tl::unexpected(std::move(error));
}

std::chrono::nanoseconds Link::Line::patience(const Request& request) const {
  if (!endpoint_.serial) return timing_.response;
  return timing_.response + wire_time(endpoint_, bytes_on_line(request, timing_.bus)) +
         2 * frame_gap(endpoint_);
}

Result<std::vector<std::uint16_t>> Link::Line::transact(const Request& request, Urgency urgency) {
  const Turn turn(*this, urgency, &request);
  if (!connection_) {
    return fail(Code::kUnavailable,
                fmt::format("drive at {}: not connected. Connect to it first", endpoint_.text()),
                ErrorReason::RIG_OFFLINE);
  }
  if (endpoint_.serial) std::this_thread::sleep_until(quiet_until_);
  if (connection_->discard_input()) counters_.add_damaged(1);
  ReplyReader reader(request, ++transaction_, framing_, timing_.bus);
  std::string cause;
  const Clock::time_point sent = Clock::now();
  bool is_ambiguous = false, expects_late = false;
  {
    const std::scoped_lock lock(mutex_);
    is_ambiguous = quiet_for(request) > sent;
    expects_late = late_.expects_any(sent);
  }
  const Connection::End end = connection_->exchange(reader, patience(request), cause);
  const Clock::time_point got = Clock::now();
  if (endpoint_.serial) quiet_until_ = got + frame_gap(endpoint_);
  counters_.add_damaged(reader.others() + (reader.has_more() ? 1 : 0));
  if (end == Connection::End::kReply) {
    counters_.add_reply(got - sent);
    return after_reply(request, is_ambiguous, *reader.reply());
  }
  after_failure(end, request, urgency);
  if (end == Connection::End::kDamaged) cause = invalid_reply("has the wrong checksum").message;
  if (end != Connection::End::kTimeout || reader.trouble().empty() || expects_late) {
    return explain(end, request, cause);
  }
  return explain(Connection::End::kDamaged, request, reader.trouble());
}

Link::Link(Endpoint endpoint, const LinkTiming& timing)
    : line_(std::make_unique<Line>(std::move(endpoint), timing)) {}
Link::~Link() = default;

Status Link::connect() { return line_->connect(); }
void Link::close() { line_->close(); }
bool Link::is_open() const { return line_->is_open(); }
std::uint64_t Link::connections() const { return line_->connections(); }
void Link::distrust(const Request& request) { line_->distrust(request); }
bool Link::may_be_confused(const Request& request) const { return line_->may_be_confused(request); }
LinkStatistics Link::statistics() const { return line_->counters().read(); }
void Link::count_retry() { line_->counters().add_retry(); }
const Endpoint& Link::endpoint() const { return line_->endpoint(); }
const LinkTiming& Link::timing() const { return line_->timing(); }

Result<std::vector<std::uint16_t>> Link::transact(const Request& request, Urgency urgency) {
  return line_->transact(request, urgency);
}

std::shared_ptr<Link> stop_link(const std::shared_ptr<Link>& link) {
  if (link->endpoint().serial || link->timing().bus.rtu_over_tcp) return link;
  return std::make_shared<Link>(link->endpoint(), link->timing());
}

}  // namespace hydroprint::drive
