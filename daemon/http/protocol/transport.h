#pragma once

#include <cstddef>
#include <string_view>

namespace hydroprint::http {

/// Result of a non-blocking operation.
struct Step {
  enum class Came {
    kDone,
    kNeedsInput,   ///< try again once the socket is readable
    kNeedsOutput,  ///< try again once the socket is writable
    kOver,         ///< the peer disconnected or violated the protocol
    kPlainHttp,    ///< from open(): the client does not use TLS
  };
  Came came = Came::kOver;
  std::size_t bytes = 0;
};

/// Transfers bytes over a socket, with or without TLS. Nothing here blocks. The socket must stay
/// open while this object is used.
class Transport {
 public:
  virtual ~Transport() = default;

  /// Performs the handshake; call this first, until it is done.
  virtual Step open() = 0;
  /// Reads some bytes; kDone if there were any.
  virtual Step read(char* into, std::size_t size) = 0;
  /// Writes as many bytes as possible; kDone with their number.
  virtual Step write(std::string_view bytes) = 0;
  /// kDone if there is something to read; consumes nothing.
  virtual Step look() = 0;
  /// Whether decrypted data is buffered, so the socket may not become readable.
  [[nodiscard]] virtual bool has_some() const = 0;
  /// Tells the peer that no more data follows.
  virtual void end() = 0;
  [[nodiscard]] virtual bool is_secure() const = 0;
};

}  // namespace hydroprint::http
