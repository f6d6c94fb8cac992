#include "daemon/api/call_forwarder.h"

#include <google/rpc/status.pb.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <atomic>
#include <future>

#include "daemon/rpc/caller_metadata.h"
#include "daemon/rpc/grpc_status.h"
#include "hydroprint/v1/artifact_service.grpc.pb.h"
#include "hydroprint/v1/asset_service.grpc.pb.h"
#include "hydroprint/v1/queue_service.grpc.pb.h"
#include "tests/daemon/auth/accounts_fixture.h"

namespace hydroprint::daemon {
namespace {

using auth::Role;
using std::chrono::seconds;
constexpr std::size_t kPiece_bytes = 100'000;

/// Reports the caller as the pause reason. PauseQueue fails if the request has a reason; otherwise
/// it waits until the call is cancelled.
class Queue final : public v1::QueueService::Service {
 public:
  grpc::Status GetQueue(grpc::ServerContext* context, const v1::GetQueueRequest*,
                        v1::Queue* reply) override {
    ++calls;
    const auto caller = caller_of(*context);
    if (!caller) return to_grpc(caller.error());
    reply->set_pause_reason(caller->name + " " + caller->via + " " + caller->credentials.peer);
    return grpc::Status::OK;
  }
  grpc::Status PauseQueue(grpc::ServerContext* context, const v1::PauseQueueRequest* request,
                          v1::Queue*) override {
    ++calls;
    if (!request->reason().empty()) {
      return to_grpc(
          fail(Code::kFailedPrecondition, request->reason(), ErrorReason::STATE_FORBIDS).value());
    }
    while (!context->IsCancelled()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    was_cancelled = true;
    return grpc::Status::CANCELLED;
  }

  std::atomic<int> calls = 0;
  std::atomic<bool> was_cancelled = false;
};

/// Counts the bytes of an upload. Fails after the first piece if the upload is named "short".
class Assets final : public v1::AssetService::Service {
 public:
  grpc::Status UploadChunk(grpc::ServerContext*, grpc::ServerReader<v1::UploadChunkRequest>* reader,
                           v1::UploadChunkResponse* reply) override {
    v1::UploadChunkRequest chunk;
    std::int64_t bytes = 0;
    while (reader->Read(&chunk)) {
      bytes += static_cast<std::int64_t>(chunk.data().size());
      if (chunk.upload() == "short")
        return to_grpc(fail(Code::kAborted, "enough", ErrorReason::STATE_FORBIDS).value());
    }
    reply->mutable_upload()->set_received_bytes(bytes);
    return grpc::Status::OK;
  }
};

/// Sends as many pieces as the request's `offset` says.
class Artifacts final : public v1::ArtifactService::Service {
 public:
  grpc::Status DownloadArtifact(grpc::ServerContext*, const v1::DownloadArtifactRequest* request,
                                grpc::ServerWriter<v1::DownloadArtifactResponse>* writer) override {
    v1::DownloadArtifactResponse piece;
    piece.set_data(std::string(kPiece_bytes, 'x'));
    for (std::int64_t i = 0; i < request->offset(); ++i) {
      if (!writer->Write(piece)) return grpc::Status::CANCELLED;
    }
    return grpc::Status::OK;
  }
};

class Forwarder : public auth::PeopleTest {
 protected:
  Forwarder() {
    grpc::ServerBuilder inner;
    inner.RegisterService(&queue);
    inner.RegisterService(&assets);
    inner.RegisterService(&artifacts);
    within_ = inner.BuildAndStart();
    forwarder_ = std::make_unique<CallForwarder>(within_->InProcessChannel({}), roles_);
    grpc::ServerBuilder outer;
    int port = 0;
    outer.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port);
    outer.RegisterCallbackGenericService(forwarder_.get());
    server_ = outer.BuildAndStart();
    channel = grpc::CreateChannel("127.0.0.1:" + std::to_string(port),
                                  grpc::InsecureChannelCredentials());
    stub = v1::QueueService::NewStub(channel);
  }
  ~Forwarder() override {
    server_->Shutdown(std::chrono::system_clock::now() + seconds(5));
    within_->Shutdown(std::chrono::system_clock::now() + seconds(5));
  }

  using Metadata = std::vector<std::pair<std::string, std::string>>;
  static std::unique_ptr<grpc::ClientContext> context(const Metadata& metadata = {}) {
    auto context = std::make_unique<grpc::ClientContext>();
    for (const auto& [name, value] : metadata) context->AddMetadata(name, value);
    context->set_deadline(std::chrono::system_clock::now() + seconds(20));
    return context;
  }
  /// "NAME VIA PEER" of the caller that the service sees; "" if the call is refused.
  std::string caller(const Metadata& metadata) {
    v1::Queue reply;
    return stub->GetQueue(context(metadata).get(), {}, &reply).ok() ? reply.pause_reason() : "";
  }

  Queue queue;
  Assets assets;
  Artifacts artifacts;
  std::shared_ptr<grpc::Channel> channel;
  std::unique_ptr<v1::QueueService::Stub> stub;

 private:
  Authenticator authenticator_{*accounts, true};
  RoleCheck roles_ =
      RoleCheck::make(authenticator_, {"hydroprint.v1.QueueService", "hydroprint.v1.AssetService",
                                       "hydroprint.v1.ArtifactService"})
          .value();
  std::unique_ptr<grpc::Server> within_, server_;
  std::unique_ptr<CallForwarder> forwarder_;
};

TEST_F(Forwarder, TheServiceSeesTheCallerThatTheEndpointEstablished) {
  EXPECT_EQ(caller({{"hydroprint-owner", "ann"}}), "ann loopback 127.0.0.1");
}

TEST_F(Forwarder, NothingThatAClientSendsPassesForAnEstablishedCaller) {
  EXPECT_EQ(caller({{"hydroprint-peer", "192.0.2.7"},
                    {"hydroprint-caller", "root"},
                    {"hydroprint-caller-role", "4"},
                    {"hydroprint-caller-via", "session"}}),
            "anonymous loopback 127.0.0.1");
  add("ann", Role::kAdmin);
  EXPECT_EQ(caller({{"hydroprint-caller", "root"}, {"hydroprint-caller-role", "4"}}), "");
}

TEST_F(Forwarder, CallIsRefusedBeforeItsMessageIsRead) {
  add("ann", Role::kAdmin);
  const auto call = context();
  grpc::CompletionQueue completions;
  grpc::GenericStub generic(channel);
  const auto stream =
      generic.PrepareCall(call.get(), "/hydroprint.v1.QueueService/PauseQueue", &completions);
  grpc::Status status;
  void* tag = nullptr;
  bool ok = false;
  stream->StartCall(&tag);
  ASSERT_TRUE(completions.Next(&tag, &ok));
  stream->Finish(&status, &tag);  // finishes the stream without a message
  ASSERT_TRUE(completions.Next(&tag, &ok));
  EXPECT_EQ(status.error_code(), grpc::StatusCode::UNAUTHENTICATED);
  EXPECT_EQ(queue.calls, 0);
}

TEST_F(Forwarder, RefusalCarriesItsReason) {
  v1::PauseQueueRequest request;
  request.set_reason("film runs out");
  v1::Queue reply;
  const auto status = stub->PauseQueue(context().get(), request, &reply);
  EXPECT_EQ(status.error_code(), grpc::StatusCode::FAILED_PRECONDITION);
  EXPECT_EQ(status.error_message(), "film runs out");
  EXPECT_NE(status.error_details().find("STATE_FORBIDS"), std::string::npos);
}

TEST_F(Forwarder, CancelReachesTheService) {
  const auto call = context();
  std::thread canceller([&] {
    while (queue.calls == 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    call->TryCancel();
  });
  v1::Queue reply;
  EXPECT_EQ(stub->PauseQueue(call.get(), {}, &reply).error_code(), grpc::StatusCode::CANCELLED);
  canceller.join();
  for (int i = 0; i < 1000 && !queue.was_cancelled; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_TRUE(queue.was_cancelled);
}

TEST_F(Forwarder, TheClientsDeadlineHoldsForTheService) {
  const auto call = context();
  call->set_deadline(std::chrono::system_clock::now() + std::chrono::milliseconds(100));
  v1::Queue reply;
  EXPECT_EQ(stub->PauseQueue(call.get(), {}, &reply).error_code(),
            grpc::StatusCode::DEADLINE_EXCEEDED);
}

TEST_F(Forwarder, ClientStreamArrivesCompletely) {
  const auto assets_stub = v1::AssetService::NewStub(channel);
  for (const int pieces : {0, 1, 50}) {
    const auto call = context();
    v1::UploadChunkResponse reply;
    const auto writer = assets_stub->UploadChunk(call.get(), &reply);
    v1::UploadChunkRequest chunk;
    chunk.set_data(std::string(kPiece_bytes, 'x'));
    for (int i = 0; i < pieces; ++i) ASSERT_TRUE(writer->Write(chunk));
    ASSERT_TRUE(writer->WritesDone());
    ASSERT_TRUE(writer->Finish().ok());
    EXPECT_EQ(reply.upload().received_bytes(), static_cast<std::int64_t>(pieces * kPiece_bytes));
  }
}

TEST_F(Forwarder, ServiceMayEndAClientStreamEarly) {
  const auto assets_stub = v1::AssetService::NewStub(channel);
  for (int round = 0; round < 20; ++round) {
    const auto call = context();
    v1::UploadChunkResponse reply;
    const auto writer = assets_stub->UploadChunk(call.get(), &reply);
    v1::UploadChunkRequest chunk;
    chunk.set_upload("short");
    chunk.set_data(std::string(kPiece_bytes, 'x'));
    for (int i = 0; i < 100 && writer->Write(chunk); ++i) {
    }
    writer->WritesDone();
    EXPECT_EQ(writer->Finish().error_code(), grpc::StatusCode::ABORTED);
  }
}

TEST_F(Forwarder, ServiceStreamArrivesCompletelyOrEndsWithTheClient) {
  const auto artifacts_stub = v1::ArtifactService::NewStub(channel);
  v1::DownloadArtifactRequest request;
  v1::DownloadArtifactResponse piece;
  for (const int pieces : {0, 1, 50}) {
    request.set_offset(pieces);
    const auto call = context();
    const auto reader = artifacts_stub->DownloadArtifact(call.get(), request);
    int received = 0;
    while (reader->Read(&piece)) ++received;
    EXPECT_TRUE(reader->Finish().ok());
    EXPECT_EQ(received, pieces);
  }
  request.set_offset(1'000'000);
  const auto call = context();
  const auto reader = artifacts_stub->DownloadArtifact(call.get(), request);
  ASSERT_TRUE(reader->Read(&piece));
  call->TryCancel();
  EXPECT_EQ(reader->Finish().error_code(), grpc::StatusCode::CANCELLED);
}

TEST_F(Forwarder, ManyCallsAtOnceAllEnd) {
  std::vector<std::future<bool>> callers;
  for (int i = 0; i < 8; ++i) {
    callers.push_back(std::async(std::launch::async, [&] {
      bool all_good = true;
      for (int k = 0; k < 200; ++k) {
        all_good = all_good && caller({{"hydroprint-owner", "ann"}}) == "ann loopback 127.0.0.1";
      }
      return all_good;
    }));
  }
  for (auto& each : callers) EXPECT_TRUE(each.get());
}

}  // namespace
}  // namespace hydroprint::daemon
