#pragma once

#include <cstddef>
#include <string_view>

namespace hydroprint::http {

/// What came of something that never waits.
struct Step {
  enum class Came {
    kDone,
    kNeedsInput,   ///< again once the socket can be read
    kNeedsOutput,  ///< again once it can be written
    kOver,         ///< the peer is gone, or says what nobody understands
    kPlainHttp,    ///< of open(): the client does not speak TLS
  };
  Came came = Came::kOver;
  std::size_t bytes = 0;
};

/// What travels over a socket, as it is or within TLS. Nothing here waits. The socket stays open
/// for as long as this is used.
class Transport {
 public:
  virtual ~Transport() = default;

  /// Before anything else; again until it is done.
  virtual Step open() = 0;
  /// kDone with some bytes.
  virtual Step read(char* into, std::size_t size) = 0;
  /// kDone with as many as got away.
  virtual Step write(std::string_view bytes) = 0;
  /// kDone if there is something to read; takes nothing.
  virtual Step look() = 0;
  /// Whether there is something to read although the socket may have nothing.
  [[nodiscard]] virtual bool has_some() const = 0;
  /// Tells the peer that nothing more comes.
  virtual void end() = 0;
  [[nodiscard]] virtual bool is_secure() const = 0;
};

}  // namespace hydroprint::http
