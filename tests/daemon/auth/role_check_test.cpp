#include "daemon/auth/role_check.h"

#include <google/protobuf/descriptor.pb.h>
#include <gtest/gtest.h>

#include "hydroprint/v1/access.pb.h"
#include "tests/daemon/auth/accounts_fixture.h"

namespace hydroprint::daemon {
namespace {

using auth::Role;

/// Creates services with one method that has the given options.
class MethodOptions : public ::testing::Test {
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

TEST_F(MethodOptions, MethodWithoutARoleIsRefused) {
  const auto refused = need({});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("MadeService.Do"), std::string::npos);
}

TEST_F(MethodOptions, MethodWithRoleAndWithoutSignInIsRefused) {
  google::protobuf::MethodOptions options;
  options.SetExtension(v1::role, v1::MAKER);
  options.SetExtension(v1::without_sign_in, true);
  EXPECT_FALSE(need(options));
}

TEST_F(MethodOptions, UnspecifiedRoleIsRefused) {
  google::protobuf::MethodOptions options;
  options.SetExtension(v1::role, v1::ROLE_UNSPECIFIED);
  EXPECT_FALSE(need(options));
}

TEST_F(MethodOptions, RoleOrWithoutSignInIsAccepted) {
  google::protobuf::MethodOptions role, none;
  role.SetExtension(v1::role, v1::MAKER);
  EXPECT_EQ(need(role).value(), Role::kMaker);
  none.SetExtension(v1::without_sign_in, true);
  const auto open = need(none);
  ASSERT_TRUE(open);
  EXPECT_FALSE(open->has_value());
}

const std::string kGet = "/hydroprint.v1.QueueService/GetQueue";      // needs VIEWER
const std::string kPause = "/hydroprint.v1.QueueService/PauseQueue";  // needs OPERATOR
const std::string kStop = "/hydroprint.v1.RigService/StopMotion";     // needs VIEWER
const std::string kSignIn = "/hydroprint.v1.PeopleService/SignIn";    // needs no sign-in

class Admission : public auth::PeopleTest {
 protected:
  static auth::Credentials from(const std::string& peer) { return {"", "", std::nullopt, peer}; }
  static auth::Credentials named(const std::string& owner) { return {"", "", owner, "127.0.0.1"}; }
  static auth::Credentials with_key(const std::string& secret) {
    return {"Bearer " + secret, "", std::nullopt, "192.0.2.7"};
  }
  static auth::Credentials with_session(const std::string& token) {
    return {"", token, std::nullopt, "192.0.2.7"};
  }
  std::string reason_of_refusal(const std::string& method, const auth::Credentials& credentials) {
    const auto caller = check.admit(method, credentials);
    return std::string(caller ? "" : name_of(caller.error().reason));
  }

  Authenticator authenticator{*accounts, true};
  RoleCheck check =
      RoleCheck::make(authenticator, {"hydroprint.v1.QueueService", "hydroprint.v1.RigService",
                                      "hydroprint.v1.PeopleService"})
          .value();
};

TEST_F(Admission, WithoutUsersLoopbackCallersAreAdminWithTheClaimedName) {
  const auto caller = check.admit(kPause, named("ann")).value().value();
  EXPECT_EQ(caller.name, "ann");
  EXPECT_EQ(caller.via, "loopback");
  EXPECT_EQ(caller.role, Role::kAdmin);
  EXPECT_FALSE(caller.is_user);
  EXPECT_EQ(check.admit(kGet, from("::1")).value()->name, "anonymous");
}

TEST_F(Admission, WithoutUsersRemoteCallersMustSignIn) {
  EXPECT_EQ(reason_of_refusal(kGet, from("192.0.2.7")), "SIGN_IN_NEEDED");
}

TEST_F(Admission, MalformedNameIsRefusedUnlessTheCallStopsMotion) {
  EXPECT_EQ(reason_of_refusal(kGet, named("two words")), "SPEC_INVALID");
  EXPECT_EQ(check.admit(kStop, named("two words")).value()->name, "anonymous");
}

TEST_F(Admission, WithUsersEveryCallerNeedsCredentials) {
  add("ann", Role::kAdmin);
  for (const auto& credentials : {from("127.0.0.1"), named("ann"), with_key("x"), with_session("x"),
                                  auth::Credentials{"Basic YTpi", "", std::nullopt, "127.0.0.1"}}) {
    EXPECT_EQ(reason_of_refusal(kGet, credentials), "SIGN_IN_NEEDED");
    EXPECT_EQ(reason_of_refusal(kStop, credentials), "SIGN_IN_NEEDED");
  }
}

TEST_F(Admission, KeysAndSessionsIdentifyTheCaller) {
  add("ann", Role::kAdmin);
  const auto key = accounts->keys().create({"ann", "", Role::kViewer, 0}).value();
  const auto session = accounts->sessions().sign_in("ann", kPassword, "p").value();
  const auto by_key = check.admit(kGet, with_key(key.second)).value().value();
  EXPECT_EQ(by_key.name, "ann");
  EXPECT_EQ(by_key.via, "key " + key.first.id);
  const auto by_session = check.admit(kGet, with_session(session.token)).value().value();
  EXPECT_EQ(by_session.name, "ann");
  EXPECT_EQ(by_session.via, "session");
}

TEST_F(Admission, InvalidKeyIsRefusedDespiteAValidSession) {
  add("ann", Role::kAdmin);
  auto credentials = with_session(accounts->sessions().sign_in("ann", kPassword, "p")->token);
  credentials.authorization = "Bearer hp_a_b";
  EXPECT_EQ(reason_of_refusal(kGet, credentials), "SIGN_IN_NEEDED");
}

TEST_F(Admission, LowerRoleIsRefused) {
  add("ann", Role::kAdmin);
  const auto viewer = accounts->keys().create({"ann", "", Role::kViewer, 0})->second;
  const auto operator_key = accounts->keys().create({"ann", "", Role::kOperator, 0})->second;
  EXPECT_EQ(reason_of_refusal(kPause, with_key(viewer)), "ROLE_TOO_LOW");
  EXPECT_TRUE(check.admit(kPause, with_key(operator_key)));
}

TEST_F(Admission, MethodsWithoutSignInAreOpenToUnknownCallers) {
  add("ann", Role::kAdmin);
  const auto caller = check.admit(kSignIn, from("192.0.2.7"));
  ASSERT_TRUE(caller);
  EXPECT_FALSE(caller->has_value());
}

TEST_F(Admission, UnknownMethodsAreRefused) {
  EXPECT_EQ(reason_of_refusal("/hydroprint.v1.QueueService/Get", from("")), "ROUTE_NOT_FOUND");
}

TEST_F(Admission, StreamEndsWithItsSession) {
  add("ann", Role::kAdmin);
  const auto session = accounts->sessions().sign_in("ann", kPassword, "p").value();
  const auto caller = check.admit(kGet, with_session(session.token)).value().value();
  EXPECT_TRUE(authenticator.check_still(caller));
  ASSERT_TRUE(accounts->sessions().end(caller.session));
  EXPECT_FALSE(authenticator.check_still(caller));
}

}  // namespace
}  // namespace hydroprint::daemon
