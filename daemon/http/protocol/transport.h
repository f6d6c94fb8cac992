#pragma once

#include <cstddef>
#include <string_view>

namespace hydroprint::http {

/// Result of a non-blocking operation.
struct Step {
  enum class Outcome {
    kDone,
    kNeedsInput,   ///< try again once the socket is readable
    kNeedsOutput,  ///< try again once the socket is writable
    kOver,         ///< the peer disconnected or violated the protocol
    kPlainHttp,    ///< from open(): the client does not use TLS
  };
  Outcome outcome = Outcome::kOver;
  std::size_t bytes = 0;
};

/// Transfers bytes over a socket, with or without TLS. Nothing here blocks. The socket must stay
/// open while this object is used.
class Transport {
 public:
  virtual ~Transport() = default;

  /// Performs the handshake. Must be called first, and again until it returns kDone.
  virtual Step open() = 0;
  /// Reads available bytes; kDone with the number of bytes if there are any.
  virtual Step read(char* into, std::size_t size) = 0;
  /// Writes as many bytes as possible; kDone with the number of bytes written.
  virtual Step write(std::string_view bytes) = 0;
  /// Returns kDone if there is something to read. Consumes nothing.
  virtual Step look() = 0;
  /// Returns whether decrypted data is buffered. If so, there may be data to read although the
  /// socket does not become readable.
  [[nodiscard]] virtual bool has_some() const = 0;
  /// Sends the peer the end of the stream.
  virtual void end() = 0;
  [[nodiscard]] virtual bool is_secure() const = 0;
};

}  // namespace hydroprint::http
