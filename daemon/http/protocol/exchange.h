#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "daemon/http/protocol/limits.h"
#include "daemon/http/protocol/request_parser.h"
#include "daemon/http/protocol/response.h"
#include "daemon/http/protocol/socket.h"

namespace hydroprint::http {

/// One request on a connection, and its response. Used on the connection's strand.
class Exchange {
 public:
  /// @param buffered  bytes received but not yet parsed; must outlive this object
  Exchange(std::shared_ptr<Socket> socket, const Limits& limits, std::string& buffered);

  /// Result of waiting for a request; kYes: head() is available.
  enum class BeginResult { kYes, kGone, kTimedOut, kMalformed, kHeaderTooLarge };
  [[nodiscard]] Task<BeginResult> begin_request(bool is_first);
  [[nodiscard]] const Head& head() const { return parser_.head(); }

  /// Reads the next piece of the body, at most 64 KiB; empty at the end. Errors: kInvalidArgument,
  /// REQUEST_MALFORMED for a malformed body; kCancelled if the client disconnects; kCancelled,
  /// REQUEST_TIMED_OUT on timeout.
  [[nodiscard]] Task<Result<std::string>> read_body_piece();
  /// Reads the whole body. Returns BODY_TOO_LARGE if the body exceeds Limits::body_bytes, or at
  /// once if Content-Length exceeds that limit.
  [[nodiscard]] Task<Result<std::string>> read_body();

  /// Sends a complete response, without the body for HEAD. Call this or begin_answer() once per
  /// request.
  [[nodiscard]] Task<bool> send(Response response);
  /// Begins a response whose body is sent with write() and ended with end_answer(); `length` is the
  /// size of the body, if known. These three functions return false if the client has disconnected.
  [[nodiscard]] Task<bool> begin_answer(Response response, std::optional<std::uint64_t> length);
  [[nodiscard]] Task<bool> write(std::string bytes);
  [[nodiscard]] Task<bool> end_answer();
  /// Closes the connection after this request. A response that has not ended stays incomplete, and
  /// the client notices that.
  void break_off() { keeps_alive_ = false; }

  /// Reads the rest of the request body if it is short. Returns whether another request may follow.
  [[nodiscard]] Task<bool> end_request();

  /// Returns the HTTP status of the response; 0 if no response has begun.
  [[nodiscard]] int status() const { return status_; }
  [[nodiscard]] Socket& socket() { return *socket_; }
  [[nodiscard]] const std::shared_ptr<Socket>& shared_socket() const { return socket_; }
  [[nodiscard]] const Limits& limits() const { return limits_; }

 private:
  [[nodiscard]] Task<bool> send_pieces(std::string_view bytes);
  [[nodiscard]] Task<Socket::ReadResult> read_more(milliseconds timeout);
  [[nodiscard]] RequestParser::Outcome parse();
  [[nodiscard]] Task<bool> invite_body();
  [[nodiscard]] bool may_drop_rest() const;

  std::shared_ptr<Socket> socket_;
  const Limits& limits_;
  std::string& buffered_;
  RequestParser parser_;
  int status_ = 0;
  bool keeps_alive_ = true;
  bool is_chunking_ = false;
  bool was_invited_ = false;  // 100 Continue was sent, or the client does not wait for it
};

}  // namespace hydroprint::http
