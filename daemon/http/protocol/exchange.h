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

/// One request on its connection, and the answer to it. Belongs to the connection's strand.
class Exchange {
 public:
  /// @param buffered  what was received of the connection and not taken yet; stays beyond this
  Exchange(std::shared_ptr<Socket> socket, const Limits& limits, std::string& buffered);

  /// What came of waiting for a request.
  enum class Begun { kYes, kGone, kTimedOut, kMalformed, kHeaderTooLarge };
  [[nodiscard]] Task<Begun> begin_request(bool is_first);
  [[nodiscard]] const Head& head() const { return parser_.head(); }

  /// A piece of the body, at most 64 KiB; empty at its end. Refuses what is no body
  /// (kInvalidArgument, REQUEST_MALFORMED) or does not come (kCancelled: the client left;
  /// REQUEST_TIMED_OUT).
  [[nodiscard]] Task<Result<std::string>> read_body_piece();
  /// All of it; BODY_TOO_LARGE beyond the limit, at once if its length was announced.
  [[nodiscard]] Task<Result<std::string>> read_body();

  /// The whole answer, without its body if HEAD was asked. Once for a request, like begin_answer().
  [[nodiscard]] Task<bool> send(Response response);
  /// The beginning of an answer whose body follows by write(), of `length` if it is known.
  /// False from any of them: the client is gone.
  [[nodiscard]] Task<bool> begin_answer(Response response, std::optional<std::uint64_t> length);
  [[nodiscard]] Task<bool> write(std::string bytes);
  [[nodiscard]] Task<bool> end_answer();
  /// Ends the connection in place of the answer's end, so that nobody takes it for whole.
  void break_off() { keeps_alive_ = false; }

  /// Reads what is left of the request if it is little; whether another request may follow.
  [[nodiscard]] Task<bool> end_request();

  /// Status of the answer; 0: none was begun.
  [[nodiscard]] int status() const { return status_; }
  [[nodiscard]] Socket& socket() { return *socket_; }
  [[nodiscard]] const std::shared_ptr<Socket>& shared_socket() const { return socket_; }
  [[nodiscard]] const Limits& limits() const { return limits_; }

 private:
  [[nodiscard]] Task<bool> send_pieces(std::string_view bytes);
  [[nodiscard]] Task<Socket::Got> read_more(milliseconds timeout);
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
  bool was_invited_ = false;  // by 100 Continue, or needed no invitation
};

}  // namespace hydroprint::http
