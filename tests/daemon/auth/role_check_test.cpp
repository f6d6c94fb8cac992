// Access to services, over the network and within the process.
#include "daemon/auth/role_check.h"

#include <google/protobuf/descriptor.pb.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <atomic>

#include "hydroprint/v1/access.pb.h"
#include "hydroprint/v1/queue_service.grpc.pb.h"
#include "tests/daemon/auth/accounts_fixture.h"

namespace hydroprint::daemon {
namespace {

using auth::Role;

// A service with one method that has these options.
class AccessOptions : public ::testing::Test {
 protected:
  Result<Need> need(const google::protobuf::MethodOptions& options) {
    google::protobuf::FileDescriptorProto file;
    file.set_name("made" + std::to_string(++count_) + ".proto");
    file.set_package("p" + std::to_string(count_));
    file.add_message_type()->set_name("Nothing");
    auto& service = *file.add_service();
    service.set_name("MadeService");
    auto& method = *service.add_method();
    method.set_name("Do");
    method.set_input_type("Nothing");
    method.set_output_type("Nothing");
    *method.mutable_options() = options;
    const auto* const made = pool_.BuildFile(file);
    return made == nullptr ? fail(Code::kInternal, "bad test")
                           : need_of(*made->service(0)->method(0));
  }

 private:
  google::protobuf::DescriptorPool pool_;
  int count_ = 0;
};

TEST_F(AccessOptions, MethodWithoutAnAccessOptionIsRefused) {
  const auto refused = need({});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("MadeService.Do"), std::string::npos);
}

TEST_F(AccessOptions, MethodWithBothOptionsOrAnUnknownRoleIsRefused) {
  google::protobuf::MethodOptions options;
  options.SetExtension(v1::role, v1::MAKER);
  options.SetExtension(v1::without_sign_in, true);
  EXPECT_FALSE(need(options));
}

TEST_F(AccessOptions, UnspecifiedRoleCountsAsMissing) {
  google::protobuf::MethodOptions options;
  options.SetExtension(v1::role, v1::ROLE_UNSPECIFIED);
  EXPECT_FALSE(need(options));
}

TEST_F(AccessOptions, RoleOrWithoutSignInIsAccepted) {
  google::protobuf::MethodOptions role, none;
  role.SetExtension(v1::role, v1::MAKER);
  EXPECT_EQ(need(role).value(), Role::kMaker);
  none.SetExtension(v1::without_sign_in, true);
  const auto open = need(none);
  ASSERT_TRUE(open);
  EXPECT_FALSE(open->has_value());
}

// A service that returns the caller.
class Inner final : public v1::QueueService::Service {
 public:
  explicit Inner(const Authenticator& access) : access_(access) {}
  grpc::Status GetQueue(grpc::ServerContext* context, const v1::GetQueueRequest*,
                        v1::Queue* reply) override {
    ++calls;
    const auto caller = access_.caller(*context);
    if (!caller) return {grpc::StatusCode::INTERNAL, caller.error().message};
    reply->set_pause_reason(caller->name + " " + caller->via + " " + peer_address(*context));
    return grpc::Status::OK;
  }
  grpc::Status PauseQueue(grpc::ServerContext*, const v1::PauseQueueRequest*, v1::Queue*) override {
    ++calls;
    return grpc::Status::OK;
  }

  static inline std::atomic<int> calls = 0;

 private:
  const Authenticator& access_;
};

class RoleCheck : public auth::PeopleTest {
 protected:
  RoleCheck() {
    Inner::calls = 0;
    gate_ = guarded("hydroprint.v1.QueueService", std::make_unique<Inner>(access_), access_, {})
                .value();
    grpc::ServerBuilder builder;
    int port = 0;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port);
    builder.RegisterService(gate_.get());
    server_ = builder.BuildAndStart();
    over_network = v1::QueueService::NewStub(grpc::CreateChannel(
        "127.0.0.1:" + std::to_string(port), grpc::InsecureChannelCredentials()));
    within = v1::QueueService::NewStub(server_->InProcessChannel({}));
  }

  using Metadata = std::vector<std::pair<std::string, std::string>>;
  grpc::Status get(v1::QueueService::Stub& stub, const Metadata& metadata) {
    grpc::ClientContext context;
    for (const auto& [name, value] : metadata) context.AddMetadata(name, value);
    v1::Queue queue;
    const auto status = stub.GetQueue(&context, {}, &queue);
    seen = queue.pause_reason();
    return status;
  }
  grpc::Status pause(v1::QueueService::Stub& stub, const Metadata& metadata) {
    grpc::ClientContext context;
    for (const auto& [name, value] : metadata) context.AddMetadata(name, value);
    v1::PauseQueueRequest request;
    request.set_reason(std::string(100'000, 'x'));  // on the heap, where a leak would show
    v1::Queue queue;
    return stub.PauseQueue(&context, request, &queue);
  }

  std::unique_ptr<v1::QueueService::Stub> over_network, within;
  std::string seen;

 private:
  Authenticator access_{*accounts, true};
  std::unique_ptr<grpc::Service> gate_;
  std::unique_ptr<grpc::Server> server_;
};

TEST_F(RoleCheck, WithoutUsersLoopbackIsAdminWithTheClaimedName) {
  EXPECT_TRUE(get(*over_network, {{"hydroprint-owner", "ann"}}).ok());
  EXPECT_EQ(seen, "ann loopback 127.0.0.1");
  EXPECT_TRUE(pause(*over_network, {}).ok());
  EXPECT_TRUE(get(*within, {{"hydroprint-peer", "127.0.0.1"}}).ok());
  EXPECT_EQ(seen, "anonymous loopback 127.0.0.1");
  EXPECT_TRUE(get(*within, {{"hydroprint-peer", "::1"}}).ok());
}

TEST_F(RoleCheck, WithoutUsersOtherMachinesAreRefused) {
  const auto status = get(*within, {{"hydroprint-peer", "192.0.2.7"}});
  EXPECT_EQ(status.error_code(), grpc::StatusCode::UNAUTHENTICATED);
  EXPECT_EQ(Inner::calls.load(), 0);
}

TEST_F(RoleCheck, PeerMetadataIsTrustedOnlyWithinTheProcess) {
  EXPECT_TRUE(get(*over_network, {{"hydroprint-peer", "192.0.2.7"}}).ok());
  EXPECT_EQ(seen, "anonymous loopback 127.0.0.1");
}

TEST_F(RoleCheck, WithUsersCredentialsAreRequiredEverywhere) {
  add("ann", Role::kAdmin);
  for (auto* const stub : {over_network.get(), within.get()}) {
    for (const Metadata& metadata :
         {Metadata{}, Metadata{{"hydroprint-owner", "ann"}},
          Metadata{{"authorization", "Bearer x"}}, Metadata{{"authorization", "Basic YTpi"}},
          Metadata{{"hydroprint-session", "x"}}}) {
      EXPECT_EQ(get(*stub, metadata).error_code(), grpc::StatusCode::UNAUTHENTICATED);
    }
  }
  EXPECT_EQ(Inner::calls.load(), 0);
}

TEST_F(RoleCheck, KeysAndSessionsIdentifyTheCaller) {
  add("ann", Role::kAdmin);
  const auto key = accounts->create_key({"ann", "", Role::kViewer, 0}).value();
  const auto session = accounts->sign_in("ann", kPassword, "p").value();
  for (auto* const stub : {over_network.get(), within.get()}) {
    EXPECT_TRUE(get(*stub, {{"authorization", "Bearer " + key.second}}).ok());
    EXPECT_TRUE(seen.starts_with("ann key " + key.first.id)) << seen;
    EXPECT_TRUE(
        get(*stub, {{"hydroprint-session", session.token}, {"hydroprint-owner", "bob"}}).ok());
    EXPECT_TRUE(seen.starts_with("ann session")) << seen;
  }
}

TEST_F(RoleCheck, SessionDoesNotReplaceAnInvalidKey) {
  add("ann", Role::kAdmin);
  const auto session = accounts->sign_in("ann", kPassword, "p").value();
  const auto status = get(
      *over_network, {{"hydroprint-session", session.token}, {"authorization", "Bearer hp_a_b"}});
  EXPECT_EQ(status.error_code(), grpc::StatusCode::UNAUTHENTICATED);
}

TEST_F(RoleCheck, UnauthorizedCallsNeverReachTheService) {
  add("ann", Role::kAdmin);
  const auto viewer = accounts->create_key({"ann", "", Role::kViewer, 0})->second;
  const auto admin = accounts->create_key({"ann", "", Role::kOperator, 0})->second;
  for (auto* const stub : {over_network.get(), within.get()}) {
    for (int i = 0; i < 20; ++i) {
      EXPECT_EQ(pause(*stub, {{"authorization", "Bearer " + viewer}}).error_code(),
                grpc::StatusCode::PERMISSION_DENIED);
    }
  }
  EXPECT_EQ(Inner::calls.load(), 0);
  EXPECT_TRUE(pause(*within, {{"authorization", "Bearer " + admin}}).ok());
  EXPECT_EQ(Inner::calls.load(), 1);
}

}  // namespace
}  // namespace hydroprint::daemon
