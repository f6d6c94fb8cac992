#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace grpc {
class Channel;
}

namespace hydroprint::http {

/// The status of a finished call, and its response.
struct Reply {
  int code = 0;
  std::string message;
  std::string details;   ///< serialised google.rpc.Status; may be empty
  std::string response;  ///< serialised; only after a successful unary call

  [[nodiscard]] bool ok() const { return code == 0; }
};

/// A running call. Thread-safe.
class Call {
 public:
  virtual ~Call() = default;
  virtual void cancel() = 0;
};

/// A streaming call, with at most one read and one write at a time. Each callback is called once,
/// on a gRPC thread, which it must not block. Destroying the stream before finish() cancels the
/// call.
class Stream {
 public:
  virtual ~Stream() = default;
  /// Reads the next message. The callback receives nullopt after the last message.
  virtual void read(std::function<void(std::optional<std::string>)> done) = 0;
  /// Writes a message. The callback receives true when the other side has accepted it, and false if
  /// the call has ended.
  virtual void write(std::string message, bool is_last, std::function<void(bool)> done) = 0;
  /// Half-closes the stream; not needed after a write() with is_last.
  virtual void end_writing() = 0;
  virtual void cancel() = 0;
  /// Reads the final status. No reads or writes may follow. Unread messages are read and dropped,
  /// so call cancel() first if there may be many.
  virtual void finish(std::function<void(Reply)> done) = 0;
};

/// Calls the services within the process. Results, errors and logs are the same as for gRPC
/// clients.
class InProcessChannel {
 public:
  /// Keys (in lower case) and values, which must be printable ASCII.
  using Metadata = std::vector<std::pair<std::string, std::string>>;

  explicit InProcessChannel(std::shared_ptr<grpc::Channel> channel);
  ~InProcessChannel();
  InProcessChannel(const InProcessChannel&) = delete;
  InProcessChannel& operator=(const InProcessChannel&) = delete;

  /// Makes a unary call. The callback is called once, on a gRPC thread, which it must not block.
  /// @param method  "/hydroprint.v1.JobService/GetJob"
  std::shared_ptr<Call> unary(const std::string& method, const std::string& request,
                              const Metadata& metadata, std::chrono::milliseconds timeout,
                              std::function<void(Reply)> done) const;
  [[nodiscard]] std::unique_ptr<Stream> stream(const std::string& method,
                                               const Metadata& metadata) const;
  /// Waits until all calls have ended, after which no callback is called. Returns false on timeout.
  [[nodiscard]] bool wait_for_none(std::chrono::milliseconds patience) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydroprint::http
