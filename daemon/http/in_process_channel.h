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

/// How a call ended: google.rpc.Code, and what came with it.
struct Reply {
  int code = 0;
  std::string message;
  std::string details;   ///< google.rpc.Status, serialised; may be empty
  std::string response;  ///< serialised; of a unary call that went well

  [[nodiscard]] bool ok() const { return code == 0; }
};

/// A call under way. Any thread may call.
class Call {
 public:
  virtual ~Call() = default;
  virtual void cancel() = 0;
};

/// A call with many messages in either direction. One read, one write at a time. Calls back once
/// each, on a thread of gRPC's, which must not be kept. Ends, if it is dropped before finish(), as
/// if it was cancelled.
class Stream {
 public:
  virtual ~Stream() = default;
  /// The next message; nothing after the last.
  virtual void read(std::function<void(std::optional<std::string>)> done) = 0;
  /// Done once the other side has taken it; false if it takes no more.
  virtual void write(std::string message, bool is_last, std::function<void(bool)> done) = 0;
  /// Nothing more is written; not needed after the last message.
  virtual void end_writing() = 0;
  virtual void cancel() = 0;
  /// How it ended, once it has; nothing is read or written after this. Messages that nobody has
  /// read are read and dropped, so cancel() first if there may be many.
  virtual void finish(std::function<void(Reply)> done) = 0;
};

/// The services, called in process: what is answered, refused and logged is what gRPC's own callers
/// get.
class InProcessChannel {
 public:
  /// Names (in lower case) and values, which must be printable ASCII.
  using Metadata = std::vector<std::pair<std::string, std::string>>;

  explicit InProcessChannel(std::shared_ptr<grpc::Channel> channel);
  ~InProcessChannel();
  InProcessChannel(const InProcessChannel&) = delete;
  InProcessChannel& operator=(const InProcessChannel&) = delete;

  /// One message for one. Calls back once, on a thread of gRPC's, which must not be kept.
  /// @param method  "/hydroprint.v1.JobService/GetJob"
  std::shared_ptr<Call> unary(const std::string& method, const std::string& request,
                              const Metadata& metadata, std::chrono::milliseconds timeout,
                              std::function<void(Reply)> done) const;
  [[nodiscard]] std::unique_ptr<Stream> stream(const std::string& method,
                                               const Metadata& metadata) const;
  /// Whether all calls ended in time, so that nobody is called back any more.
  [[nodiscard]] bool wait_for_none(std::chrono::milliseconds patience) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydroprint::http
