#include "daemon/http/protocol/exchange.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

namespace hydroprint::http {
namespace {

constexpr std::size_t kPiece_bytes = 64 << 10;
constexpr std::size_t kHeadPiece_bytes = 4 << 10;
// Limits a header, and the first line of a chunk.
constexpr std::size_t kMostUnparsed_bytes = 32 << 10;
constexpr std::uint64_t kMostDropped_bytes = 64 << 10;

using SteadyClock = std::chrono::steady_clock;

milliseconds left_until(SteadyClock::time_point end) {
  const auto left = std::chrono::duration_cast<milliseconds>(end - SteadyClock::now());
  return std::max(left, milliseconds(1));
}

Error client_left() { return {Code::kCancelled, "the client disconnected"}; }

std::string chunk_of(std::string_view bytes) {
  std::array<char, 20> size{};
  const auto end = std::to_chars(size.data(), size.data() + size.size(), bytes.size(), 16);
  std::string chunk(size.data(), end.ptr);
  chunk.append("\r\n").append(bytes).append("\r\n");
  return chunk;
}

}  // namespace

Exchange::Exchange(std::shared_ptr<Socket> socket, const Limits& limits, std::string& buffered)
    : socket_(std::move(socket)),
      limits_(limits),
      buffered_(buffered),
      parser_(limits.header_bytes) {}

Task<Socket::ReadResult> Exchange::read_more(milliseconds timeout) {
  const std::size_t before = buffered_.size();
  const std::size_t most = parser_.has_head() ? kPiece_bytes : kHeadPiece_bytes;
  buffered_.resize(before + most);
  const Socket::ReadResult got = co_await socket_->read(buffered_.data() + before, most, timeout);
  buffered_.resize(before + got.bytes);
  co_return got;
}

// Parses as much as possible of the received bytes.
RequestParser::Outcome Exchange::parse() {
  std::size_t used = 0;
  const auto outcome = parser_.put(buffered_, used);
  buffered_.erase(0, used);
  return outcome;
}

Task<Exchange::BeginResult> Exchange::begin_request(bool is_first) {
  if (buffered_.empty()) {
    buffered_.shrink_to_fit();  // so that idle connections do not occupy buffers
    const bool in_time =
        co_await socket_->readable(is_first ? limits_.header_time : limits_.idle_time);
    if (!in_time) co_return BeginResult::kGone;
  }
  const auto end = SteadyClock::now() + limits_.header_time;
  for (;;) {
    // Skips empty lines before a request.
    buffered_.erase(0, std::min(buffered_.find_first_not_of("\r\n"), buffered_.size()));
    if (!buffered_.empty()) {
      const auto outcome = parse();
      if (outcome == RequestParser::Outcome::kMalformed) co_return BeginResult::kMalformed;
      if (outcome == RequestParser::Outcome::kHeaderTooLarge)
        co_return BeginResult::kHeaderTooLarge;
      if (parser_.has_head()) break;
      if (buffered_.size() > kMostUnparsed_bytes) co_return BeginResult::kHeaderTooLarge;
    }
    const Socket::ReadResult got = co_await read_more(left_until(end));
    if (got.bytes > 0) continue;
    co_return got.timed_out && !buffered_.empty() ? BeginResult::kTimedOut : BeginResult::kGone;
  }
  keeps_alive_ = head().keeps_alive && head().has_known_end();
  was_invited_ = !head().expects_continue;
  co_return BeginResult::kYes;
}

Task<bool> Exchange::invite_body() {
  if (was_invited_ || !buffered_.empty()) co_return true;
  was_invited_ = true;
  co_return co_await socket_->written("HTTP/1.1 100 Continue\r\n\r\n", limits_.write_time);
}

Task<Result<std::string>> Exchange::read_body_piece() {
  const bool is_invited = co_await invite_body();
  if (!is_invited) co_return tl::unexpected(client_left());
  for (;;) {
    std::string piece = parser_.take_body();
    if (!piece.empty() || parser_.is_done()) co_return piece;
    auto outcome = RequestParser::Outcome::kNeedsMore;
    if (!buffered_.empty()) outcome = parse();
    if (outcome == RequestParser::Outcome::kProgress) continue;
    if (outcome != RequestParser::Outcome::kNeedsMore || buffered_.size() > kMostUnparsed_bytes) {
      break_off();
      co_return fail(
          Code::kInvalidArgument,
          "the framing of the request body is not valid HTTP/1.1; check Content-Length or "
          "the chunk sizes",
          ErrorReason::REQUEST_MALFORMED);
    }
    const Socket::ReadResult got = co_await read_more(limits_.body_time);
    if (got.bytes > 0) continue;
    break_off();
    if (!got.timed_out) co_return tl::unexpected(client_left());
    co_return fail(Code::kCancelled, "the request body did not arrive in time; send it again",
                   ErrorReason::REQUEST_TIMED_OUT);
  }
}

Task<Result<std::string>> Exchange::read_body() {
  std::string body;
  const auto refused = [&] {
    auto error = fail(
        Code::kOutOfRange,
        fmt::format("the request body is longer than {} bytes; upload files with POST /v1/uploads",
                    limits_.body_bytes),
        ErrorReason::BODY_TOO_LARGE);
    error.value().metadata["max_bytes"] = std::to_string(limits_.body_bytes);
    return error;
  };
  if (head().content_length.value_or(0) > limits_.body_bytes) co_return refused();
  for (;;) {
    Result<std::string> piece = co_await read_body_piece();
    if (!piece || piece->empty()) {
      if (!piece) co_return piece;
      co_return body;
    }
    body += *piece;
    if (body.size() > limits_.body_bytes) co_return refused();
  }
}

// Sends the bytes in pieces, each with its own timeout, so that a slow client is not disconnected
// as long as it reads.
Task<bool> Exchange::send_pieces(std::string_view bytes) {
  while (!bytes.empty()) {
    const std::string_view piece = bytes.substr(0, kPiece_bytes);
    const bool sent = co_await socket_->written(piece, limits_.write_time);
    if (!sent) {
      break_off();
      co_return false;
    }
    bytes.remove_prefix(piece.size());
  }
  co_return true;
}

Task<bool> Exchange::send(Response response) {
  status_ = response.status;
  if (!may_drop_rest()) break_off();
  const std::string& content = response.content();
  std::string text =
      head_text(response, head(), {content.size(), keeps_alive_, socket_->is_secure()});
  const bool has_body = head().method != "HEAD";
  if (!has_body || content.size() > kPiece_bytes) {
    const bool sent = co_await send_pieces(text);
    if (!sent || !has_body) co_return sent;
    co_return co_await send_pieces(content);
  }
  text += content;
  co_return co_await send_pieces(text);
}

Task<bool> Exchange::begin_answer(Response response, std::optional<std::uint64_t> length) {
  status_ = response.status;
  is_chunking_ = !length && head().version >= 11;
  if (!length && !is_chunking_) break_off();
  const std::string text =
      head_text(response, head(), {length, keeps_alive_, socket_->is_secure()});
  co_return co_await send_pieces(text);
}

Task<bool> Exchange::write(std::string bytes) {
  if (bytes.empty()) co_return true;
  if (is_chunking_) bytes = chunk_of(bytes);
  co_return co_await send_pieces(bytes);
}

Task<bool> Exchange::end_answer() {
  if (!is_chunking_) co_return true;
  co_return co_await send_pieces("0\r\n\r\n");
}

// Returns whether to read the rest of the body in order to keep the connection. If the client still
// waits for 100 Continue, it may or may not send the body, so the start of the next request is
// unknown.
bool Exchange::may_drop_rest() const {
  if (parser_.is_done()) return true;
  return was_invited_ && head().content_length.value_or(0) <= kMostDropped_bytes;
}

Task<bool> Exchange::end_request() {
  std::uint64_t dropped = parser_.take_body().size();
  while (keeps_alive_ && !parser_.is_done()) {
    if (!may_drop_rest() || dropped > kMostDropped_bytes) break_off();
    if (!keeps_alive_) break;
    const Result<std::string> piece = co_await read_body_piece();
    if (!piece) break_off();
    if (piece) dropped += piece->size();
  }
  co_return keeps_alive_ && !socket_->is_closed();
}

}  // namespace hydroprint::http
