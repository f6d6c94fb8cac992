#include "daemon/http/in_process_channel.h"

#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>
#include <grpcpp/generic/generic_stub.h>

#include <condition_variable>
#include <mutex>

namespace hydroprint::http {
namespace {

grpc::ByteBuffer packed(const std::string& bytes) {
  const grpc::Slice slice(bytes);
  return grpc::ByteBuffer(&slice, 1);
}

std::string unpacked(const grpc::ByteBuffer& buffer) {
  grpc::Slice slice;
  if (!buffer.DumpToSingleSlice(&slice).ok()) return {};
  return {reinterpret_cast<const char*>(slice.begin()), slice.size()};
}

Reply reply_of(const grpc::Status& status) {
  return {status.error_code(), status.error_message(), status.error_details(), {}};
}

void fill(grpc::ClientContext& context, const InProcessChannel::Metadata& metadata) {
  for (const auto& [name, value] : metadata) context.AddMetadata(name, value);
}

/// Counts the calls whose callbacks may still be called.
class Calls {
 public:
  void begin() {
    const std::lock_guard lock(mutex_);
    ++count_;
  }
  void end() {
    const std::lock_guard lock(mutex_);
    --count_;
    ended_.notify_all();
  }
  bool wait_for_none(std::chrono::milliseconds patience) {
    std::unique_lock lock(mutex_);
    return ended_.wait_for(lock, patience, [&] { return count_ == 0; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable ended_;
  int count_ = 0;
};

/// Counts one call while this object exists.
class OneCall {
 public:
  explicit OneCall(std::shared_ptr<Calls> calls) : calls_(std::move(calls)) { calls_->begin(); }
  ~OneCall() { calls_->end(); }
  OneCall(const OneCall&) = delete;
  OneCall& operator=(const OneCall&) = delete;

 private:
  std::shared_ptr<Calls> calls_;
};

class UnaryCall final : public Call {
 public:
  explicit UnaryCall(std::shared_ptr<Calls> calls) : one_(std::move(calls)) {}
  void cancel() override { context.TryCancel(); }

  grpc::ClientContext context;
  grpc::ByteBuffer request, response;

 private:
  OneCall one_;
};

/// The part of a stream that gRPC uses. It lives until gRPC reports the end of the call, even if
/// the GrpcStream was destroyed before.
class Reactor final : public grpc::ClientBidiReactor<grpc::ByteBuffer, grpc::ByteBuffer> {
 public:
  explicit Reactor(std::shared_ptr<Calls> calls) : one_(std::move(calls)) {}

  static std::shared_ptr<Reactor> begin(grpc::GenericStub& stub, std::shared_ptr<Calls> calls,
                                        const std::string& method,
                                        const InProcessChannel::Metadata& metadata) {
    auto reactor = std::make_shared<Reactor>(std::move(calls));
    reactor->itself_ = reactor;
    fill(reactor->context_, metadata);
    stub.PrepareBidiStreamingCall(&reactor->context_, method, {}, reactor.get());
    reactor->AddHold();  // until finish(), because reads and writes start outside gRPC's callbacks
    reactor->StartCall();
    return reactor;
  }

  void read(std::function<void(std::optional<std::string>)> done) {
    {
      const std::lock_guard lock(mutex_);
      read_done_ = std::move(done);
      is_reading_ = true;
    }
    StartRead(&incoming_);
  }

  void write(const std::string& message, bool is_last, std::function<void(bool)> done) {
    {
      const std::lock_guard lock(mutex_);
      outgoing_ = packed(message);
      write_done_ = std::move(done);
    }
    is_last ? StartWriteLast(&outgoing_, {}) : StartWrite(&outgoing_);
  }

  void end_writing() { StartWritesDone(); }
  void cancel() { context_.TryCancel(); }

  void finish(std::function<void(Reply)> done) {
    bool was_reading = false;
    {
      const std::lock_guard lock(mutex_);
      done_ = std::move(done);
      read_done_ = nullptr;
      was_reading = std::exchange(is_reading_, true);
    }
    // Reads all remaining messages, because gRPC reports the status only after them.
    if (!was_reading) StartRead(&incoming_);
    RemoveHold();
  }

  void OnReadDone(bool ok) override {
    std::function<void(std::optional<std::string>)> done;
    {
      const std::lock_guard lock(mutex_);
      done = std::exchange(read_done_, nullptr);
      if (done) is_reading_ = false;
    }
    if (done) {
      done(ok ? std::optional(unpacked(incoming_)) : std::nullopt);
    } else if (ok) {
      StartRead(&incoming_);
    }
  }
  void OnWriteDone(bool ok) override {
    std::function<void(bool)> done;
    {
      const std::lock_guard lock(mutex_);
      done = std::exchange(write_done_, nullptr);
    }
    done(ok);
  }

  void OnDone(const grpc::Status& status) override {
    const auto kept = std::exchange(itself_, nullptr);
    std::function<void(Reply)> done;
    {
      const std::lock_guard lock(mutex_);
      done = std::exchange(done_, nullptr);
    }
    if (done) done(reply_of(status));
  }

 private:
  OneCall one_;
  grpc::ClientContext context_;
  grpc::ByteBuffer incoming_;
  std::mutex mutex_;  // protects the members below
  grpc::ByteBuffer outgoing_;
  std::function<void(std::optional<std::string>)> read_done_;
  std::function<void(bool)> write_done_;
  bool is_reading_ = false;
  std::function<void(Reply)> done_;
  std::shared_ptr<Reactor> itself_;
};

class GrpcStream final : public Stream {
 public:
  explicit GrpcStream(std::shared_ptr<Reactor> reactor) : reactor_(std::move(reactor)) {}
  ~GrpcStream() override {
    if (is_finished_) return;
    reactor_->cancel();
    reactor_->finish(nullptr);
  }

  void read(std::function<void(std::optional<std::string>)> done) override {
    reactor_->read(std::move(done));
  }
  void write(std::string message, bool is_last, std::function<void(bool)> done) override {
    reactor_->write(message, is_last, std::move(done));
  }
  void end_writing() override { reactor_->end_writing(); }
  void cancel() override { reactor_->cancel(); }
  void finish(std::function<void(Reply)> done) override {
    is_finished_ = true;
    reactor_->finish(std::move(done));
  }

 private:
  std::shared_ptr<Reactor> reactor_;
  bool is_finished_ = false;
};

}  // namespace

struct InProcessChannel::Impl {
  grpc::GenericStub stub;
  std::shared_ptr<Calls> calls;
};

InProcessChannel::InProcessChannel(std::shared_ptr<grpc::Channel> channel)
    : impl_(new Impl{grpc::GenericStub(std::move(channel)), std::make_shared<Calls>()}) {}
InProcessChannel::~InProcessChannel() = default;

std::shared_ptr<Call> InProcessChannel::unary(const std::string& method, const std::string& request,
                                              const Metadata& metadata,
                                              std::chrono::milliseconds timeout,
                                              std::function<void(Reply)> done) const {
  auto call = std::make_shared<UnaryCall>(impl_->calls);
  fill(call->context, metadata);
  call->context.set_deadline(std::chrono::system_clock::now() + timeout);
  call->request = packed(request);
  impl_->stub.UnaryCall(&call->context, method, {}, &call->request, &call->response,
                        [call, done = std::move(done)](const grpc::Status& status) {
                          Reply reply = reply_of(status);
                          if (reply.ok()) reply.response = unpacked(call->response);
                          done(std::move(reply));
                        });
  return call;
}

std::unique_ptr<Stream> InProcessChannel::stream(const std::string& method,
                                                 const Metadata& metadata) const {
  return std::make_unique<GrpcStream>(Reactor::begin(impl_->stub, impl_->calls, method, metadata));
}

bool InProcessChannel::wait_for_none(std::chrono::milliseconds patience) const {
  return impl_->calls->wait_for_none(patience);
}

}  // namespace hydroprint::http
