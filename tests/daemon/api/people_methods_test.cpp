// Calls every method of every service with every role through the real daemon, and compares with
// the methods' access options.
#include <google/protobuf/descriptor.h>
#include <grpcpp/generic/generic_stub.h>

#include <fstream>

#include "hydroprint/v1/access.pb.h"
#include "hydroprint/v1/calibration_service.pb.h"
#include "hydroprint/v1/camera_service.pb.h"
#include "hydroprint/v1/event_service.pb.h"
#include "hydroprint/v1/lease_service.pb.h"
#include "hydroprint/v1/preview_service.pb.h"
#include "hydroprint/v1/rig_service.pb.h"
#include "tests/daemon/api/people_support.h"
#include "tests/support/paths.h"

namespace hydroprint::tests {
namespace {

using google::protobuf::MethodDescriptor;

std::vector<const google::protobuf::ServiceDescriptor*> all_services() {
  std::vector<const google::protobuf::ServiceDescriptor*> services;
  for (const google::protobuf::Descriptor* const message :
       {v1::GetArtifactRequest::descriptor(), v1::GetAssetRequest::descriptor(),
        v1::GetCalibrationRequest::descriptor(), v1::GetDepthPictureRequest::descriptor(),
        v1::GetJobRequest::descriptor(), v1::GetLeaseRequest::descriptor(),
        v1::ComputePreviewRequest::descriptor(), v1::GetQueueRequest::descriptor(),
        v1::GetRigRequest::descriptor(), v1::WatchEventsRequest::descriptor(),
        v1::WhoAmIRequest::descriptor()}) {
    for (int i = 0; i < message->file()->service_count(); ++i) {
      services.push_back(message->file()->service(i));
    }
  }
  return services;
}

// Calls the method with an empty request; cancels a stream after its first message.
grpc::Status call_empty(Client& client, const MethodDescriptor& method) {
  grpc::GenericStub stub(client.channel);
  const auto context = client.context();
  grpc::CompletionQueue queue;
  const std::string name = "/" + method.service()->full_name() + "/" + method.name();
  const auto call = stub.PrepareCall(context.get(), name, &queue);
  const auto wait = [&queue] {
    void* tag = nullptr;
    bool ok = false;
    return queue.Next(&tag, &ok) && ok;
  };
  call->StartCall(nullptr);
  if (wait()) {
    call->WriteLast(grpc::ByteBuffer(nullptr, 0), {}, nullptr);
    (void)wait();
  }
  grpc::ByteBuffer reply;
  call->Read(&reply, nullptr);
  if (wait() && method.server_streaming()) context->TryCancel();
  grpc::Status status;
  call->Finish(&status, nullptr);
  (void)wait();
  return status;
}

v1::Role role_of(const std::string& user) {
  if (user == "admin") return v1::ADMIN;
  if (user == "operator") return v1::OPERATOR;
  if (user == "viewer") return v1::VIEWER;
  return user.empty() ? v1::ROLE_UNSPECIFIED : v1::MAKER;
}

void expect_as_stated(const MethodDescriptor& method, const std::string& user,
                      const grpc::Status& status) {
  const std::string what = method.full_name() + " as \"" + user + "\": " + status.error_message();
  const std::string reason = error_info(status).reason();
  if (method.options().GetExtension(v1::without_sign_in)) {
    EXPECT_NE(reason, "SIGN_IN_NEEDED") << what;
    EXPECT_NE(status.error_code(), grpc::StatusCode::PERMISSION_DENIED) << what;
    return;
  }
  if (user.empty()) {
    EXPECT_EQ(status.error_code(), grpc::StatusCode::UNAUTHENTICATED) << what;
    EXPECT_EQ(reason, "SIGN_IN_NEEDED") << what;
  } else if (role_of(user) < method.options().GetExtension(v1::role)) {
    EXPECT_EQ(status.error_code(), grpc::StatusCode::PERMISSION_DENIED) << what;
    EXPECT_EQ(reason, "ROLE_TOO_LOW") << what;
  } else {
    EXPECT_NE(status.error_code(), grpc::StatusCode::UNAUTHENTICATED) << what;
    EXPECT_NE(status.error_code(), grpc::StatusCode::PERMISSION_DENIED) << what;
    EXPECT_NE(status.error_code(), grpc::StatusCode::UNIMPLEMENTED) << what;
    EXPECT_NE(status.error_code(), grpc::StatusCode::UNKNOWN) << what;
  }
}

TEST_F(PeopleApi, EveryMethodAdmitsExactlyTheStatedRoles) {
  int methods = 0;
  for (const auto* const service : all_services()) {
    for (int i = 0; i < service->method_count(); ++i, ++methods) {
      const MethodDescriptor& method = *service->method(i);
      for (const char* const user : {"", "viewer", "maker", "operator", "admin"}) {
        const auto client = as(user);
        expect_as_stated(method, user, call_empty(*client, method));
      }
    }
  }
  EXPECT_GE(methods, 58);
}

TEST_F(PeopleApi, AllServicesAreCovered) {
  std::set<std::string> known, there;
  for (const auto* const service : all_services()) known.insert(service->name());
  for (const auto& entry :
       std::filesystem::directory_iterator(testing::source_path("proto/hydroprint/v1"))) {
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);) {
      if (line.starts_with("service ")) there.insert(line.substr(8, line.find(' ', 8) - 8));
    }
  }
  EXPECT_EQ(known, there);
}

}  // namespace
}  // namespace hydroprint::tests
