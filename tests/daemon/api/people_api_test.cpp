// Users and ownership, through the real daemon.
#include "hydroprint/v1/lease_service.grpc.pb.h"
#include "hydroprint/v1/rig_service.grpc.pb.h"
#include "tests/daemon/api/people_support.h"

namespace hydroprint::tests {
namespace {

using grpc::StatusCode;

void expect_refusal(const grpc::Status& status, StatusCode code, const std::string& reason) {
  EXPECT_EQ(status.error_code(), code) << status.error_message();
  EXPECT_EQ(error_info(status).reason(), reason) << status.error_message();
}

v1::Job get(Client& client, const std::string& name) { return client.job(name); }

grpc::Status share(Client& client, const std::string& name, bool shared) {
  v1::ShareJobRequest request;
  request.set_name(name);
  request.set_shared(shared);
  v1::Job job;
  return client.jobs->ShareJob(client.context().get(), request, &job);
}

grpc::Status cancel(Client& client, const std::string& name) {
  v1::CancelJobRequest request;
  request.set_name(name);
  v1::Job job;
  return client.jobs->CancelJob(client.context().get(), request, &job);
}

grpc::Status remove(Client& client, const std::string& name) {
  v1::DeleteJobRequest request;
  request.set_name(name);
  google::protobuf::Empty empty;
  return client.jobs->DeleteJob(client.context().get(), request, &empty);
}

grpc::Status retry(Client& client, const std::string& name, v1::Job& job) {
  v1::RetryJobRequest request;
  request.set_name(name);
  return client.jobs->RetryJob(client.context().get(), request, &job);
}

grpc::Status list_artifacts(Client& client, const std::string& name) {
  v1::ListArtifactsRequest request;
  request.set_parent(name);
  v1::ListArtifactsResponse reply;
  return client.artifacts->ListArtifacts(client.context().get(), request, &reply);
}

grpc::Status get_artifact(Client& client, const std::string& name) {
  v1::GetArtifactRequest request;
  request.set_name(name);
  v1::Artifact reply;
  return client.artifacts->GetArtifact(client.context().get(), request, &reply);
}

grpc::Status download(Client& client, const std::string& name) {
  v1::DownloadArtifactRequest request;
  request.set_name(name);
  const auto context = client.context();
  const auto reader = client.artifacts->DownloadArtifact(context.get(), request);
  v1::DownloadArtifactResponse chunk;
  while (reader->Read(&chunk)) {
  }
  return reader->Finish();
}

grpc::Status report(Client& client, const std::string& name) {
  v1::GetJobReportRequest request;
  request.set_name(name);
  v1::JobReport reply;
  return client.jobs->GetJobReport(client.context().get(), request, &reply);
}

std::vector<v1::AuditEntry> audit(Client& client, const std::string& what) {
  v1::ListAuditRequest request;
  request.set_what(what);
  v1::ListAuditResponse reply;
  const auto status = client.people->ListAudit(client.context().get(), request, &reply);
  EXPECT_TRUE(status.ok()) << status.error_message();
  return {reply.entries().begin(), reply.entries().end()};
}

TEST_F(PeopleApi, JobsAreOwnedByTheAuthenticatedCaller) {
  // The client claims the owner "admin" in the metadata hydroprint-owner.
  Client client(daemon.address(), "admin");
  client.key = keys["maker"];
  EXPECT_EQ(client.simulate("x").owner(), "maker");
}

TEST_F(PeopleApi, ResultsAreVisibleToOwnerAndOperatorsUnlessShared) {
  const auto maker = as("maker");
  const std::string name = maker->simulate("mesh").name();
  maker->wait_for_end(name);
  const std::string film = name + "/artifacts/film.png";
  for (const char* const user : {"maker", "operator", "admin"}) {
    const auto client = as(user);
    EXPECT_TRUE(list_artifacts(*client, name).ok()) << user;
    EXPECT_TRUE(download(*client, film).ok()) << user;
    EXPECT_TRUE(report(*client, name).ok()) << user;
    EXPECT_EQ(get(*client, name).simulate().mesh().name(), "m.obj") << user;
  }
  for (const char* const user : {"other", "viewer"}) {
    const auto client = as(user);
    expect_refusal(list_artifacts(*client, name), StatusCode::PERMISSION_DENIED, "NOT_YOURS");
    expect_refusal(get_artifact(*client, film), StatusCode::PERMISSION_DENIED, "NOT_YOURS");
    expect_refusal(download(*client, film), StatusCode::PERMISSION_DENIED, "NOT_YOURS");
    expect_refusal(report(*client, name), StatusCode::PERMISSION_DENIED, "NOT_YOURS");
    const v1::Job seen = get(*client, name);
    EXPECT_EQ(seen.owner(), "maker");  // every user may see the owners of jobs
    EXPECT_TRUE(seen.has_simulate());
    EXPECT_FALSE(seen.simulate().has_mesh()) << seen.ShortDebugString();
  }
  ASSERT_TRUE(share(*maker, name, true).ok());
  for (const char* const user : {"other", "viewer"}) {
    const auto client = as(user);
    EXPECT_TRUE(list_artifacts(*client, name).ok()) << user;
    EXPECT_TRUE(download(*client, film).ok()) << user;
    EXPECT_TRUE(report(*client, name).ok()) << user;
    EXPECT_EQ(get(*client, name).simulate().mesh().name(), "m.obj") << user;
  }
  ASSERT_TRUE(share(*maker, name, false).ok());
  expect_refusal(download(*as("other"), film), StatusCode::PERMISSION_DENIED, "NOT_YOURS");
}

TEST_F(PeopleApi, ListsAndWatchesHideFilesToo) {
  const auto maker = as("maker");
  const std::string name = maker->simulate("mesh").name();
  maker->wait_for_end(name);
  const auto other = as("other");
  v1::ListJobsResponse page;
  ASSERT_TRUE(other->jobs->ListJobs(other->context().get(), {}, &page).ok());
  ASSERT_EQ(page.jobs_size(), 1);
  EXPECT_FALSE(page.jobs(0).simulate().has_mesh());
  v1::WatchJobRequest request;
  request.set_name(name);
  const auto context = other->context();
  const auto reader = other->jobs->WatchJob(context.get(), request);
  v1::WatchJobResponse message;
  ASSERT_TRUE(reader->Read(&message));
  EXPECT_TRUE(message.job().has_simulate());
  EXPECT_FALSE(message.job().simulate().has_mesh());
}

TEST_F(PeopleApi, OnlyOwnerAndOperatorsChangeAJob) {
  const auto maker = as("maker"), other = as("other");
  const auto admin = as("admin"), operator_user = as("operator");
  v1::Job job;
  const std::string one = maker->simulate("sleep 60").name();
  expect_refusal(cancel(*other, one), StatusCode::PERMISSION_DENIED, "NOT_YOURS");
  EXPECT_TRUE(cancel(*maker, one).ok());
  maker->wait_for_end(one);
  expect_refusal(remove(*other, one), StatusCode::PERMISSION_DENIED, "NOT_YOURS");
  expect_refusal(retry(*other, one, job), StatusCode::PERMISSION_DENIED, "NOT_YOURS");
  expect_refusal(share(*other, one, true), StatusCode::PERMISSION_DENIED, "NOT_YOURS");
  EXPECT_TRUE(retry(*operator_user, one, job).ok());
  EXPECT_EQ(job.owner(), "operator");
  expect_refusal(cancel(*maker, job.name()), StatusCode::PERMISSION_DENIED, "NOT_YOURS");
  EXPECT_TRUE(cancel(*admin, job.name()).ok());
  EXPECT_TRUE(remove(*maker, one).ok());
}

TEST_F(PeopleApi, ReferringToAJobGivesNoAccessToItsFiles) {
  const auto maker = as("maker"), other = as("other");
  const std::string name = maker->simulate("mesh").name();
  maker->wait_for_end(name);
  v1::CreateJobRequest print, page, send;
  print.mutable_job()->mutable_print_image()->set_simulate_job(name);
  page.mutable_job()->mutable_template_()->set_simulate_job(name);
  send.mutable_job()->mutable_print()->set_print_image_job(name);
  for (const auto& request : {print, page, send}) {
    v1::Job job;
    expect_refusal(other->create(request, job), StatusCode::PERMISSION_DENIED, "NOT_YOURS");
    EXPECT_NE(error_info(maker->create(request, job)).reason(), "NOT_YOURS");
  }
}

TEST_F(PeopleApi, OnlyOperatorsCreateRigJobs) {
  v1::CreateJobRequest dip, capture, calibrate, lens;
  dip.mutable_job()->mutable_dip();
  capture.mutable_job()->mutable_capture();
  calibrate.mutable_job()->mutable_calibrate();
  lens.mutable_job()->mutable_calibrate_camera();
  for (const auto& request : {dip, capture, calibrate, lens}) {
    v1::Job job;
    expect_refusal(as("maker")->create(request, job), StatusCode::PERMISSION_DENIED,
                   "ROLE_TOO_LOW");
    EXPECT_NE(as("operator")->create(request, job).error_code(), StatusCode::PERMISSION_DENIED);
  }
}

TEST_F(PeopleApi, SessionEndsWhenSignedOutOrRevoked) {
  const auto in = sign_in("maker");
  Client client(daemon.address());
  client.session = in.session_token();
  v1::WhoAmIResponse who;
  ASSERT_TRUE(client.people->WhoAmI(client.context().get(), {}, &who).ok());
  EXPECT_EQ(who.user(), "maker");
  EXPECT_EQ(who.role(), v1::MAKER);
  EXPECT_EQ(who.csrf_token(), in.csrf_token());
  EXPECT_TRUE(who.accounts());
  google::protobuf::Empty empty;
  ASSERT_TRUE(client.people->SignOut(client.context().get(), {}, &empty).ok());
  expect_refusal(client.people->WhoAmI(client.context().get(), {}, &who),
                 StatusCode::UNAUTHENTICATED, "SIGN_IN_NEEDED");

  client.session = sign_in("maker").session_token();
  v1::ListSessionsResponse sessions;
  ASSERT_TRUE(client.people->ListSessions(client.context().get(), {}, &sessions).ok());
  v1::RevokeSessionRequest revoke;
  for (const v1::Session& session : sessions.sessions()) {
    EXPECT_EQ(session.user(), "users/maker");
    if (session.current()) revoke.set_name(session.name());
  }
  const auto other = as("other");
  expect_refusal(other->people->RevokeSession(other->context().get(), revoke, &empty),
                 StatusCode::NOT_FOUND, "SESSION_NOT_FOUND");
  const auto admin = as("admin");
  ASSERT_TRUE(admin->people->RevokeSession(admin->context().get(), revoke, &empty).ok());
  expect_refusal(client.people->WhoAmI(client.context().get(), {}, &who),
                 StatusCode::UNAUTHENTICATED, "SIGN_IN_NEEDED");
}

TEST_F(PeopleApi, StreamEndsWithItsSession) {
  Client client(daemon.address());
  client.session = sign_in("maker").session_token();
  const std::string job = client.simulate("sleep 60").name();
  v1::WatchJobRequest request;
  request.set_name(job);
  const auto job_call = client.context(), rig_call = client.context();
  const auto job_events = client.jobs->WatchJob(job_call.get(), request);
  const auto rig = v1::RigService::NewStub(client.channel);
  const auto rig_events = rig->WatchRig(rig_call.get(), {});
  v1::WatchJobResponse event;
  v1::Rig state;
  ASSERT_TRUE(job_events->Read(&event));
  ASSERT_TRUE(rig_events->Read(&state));
  google::protobuf::Empty empty;
  ASSERT_TRUE(client.people->SignOut(client.context().get(), {}, &empty).ok());
  while (job_events->Read(&event)) {
  }
  while (rig_events->Read(&state)) {
  }
  expect_refusal(job_events->Finish(), StatusCode::UNAUTHENTICATED, "SIGN_IN_NEEDED");
  expect_refusal(rig_events->Finish(), StatusCode::UNAUTHENTICATED, "SIGN_IN_NEEDED");
  EXPECT_TRUE(cancel(*as("maker"), job).ok());
}

TEST_F(PeopleApi, KeyCannotSetTheFirstPassword) {
  const auto admin = as("admin");
  v1::SetPasswordRequest none;
  none.set_name("users/operator");
  v1::User user;
  ASSERT_TRUE(admin->people->SetPassword(admin->context().get(), none, &user).ok());
  EXPECT_FALSE(user.has_password());
  none.set_new_password("battery staple");
  const auto operator_user = as("operator");
  expect_refusal(operator_user->people->SetPassword(operator_user->context().get(), none, &user),
                 StatusCode::PERMISSION_DENIED, "SIGN_IN_FAILED");
}

TEST_F(PeopleApi, KeyNeverHasAHigherRoleThanItsUser) {
  const auto admin = as("operator");
  v1::CreateApiKeyRequest request;
  request.set_role(v1::ADMIN);
  v1::CreateApiKeyResponse reply;
  expect_refusal(admin->people->CreateApiKey(admin->context().get(), request, &reply),
                 StatusCode::PERMISSION_DENIED, "ROLE_TOO_LOW");
  request.set_role(v1::VIEWER);
  ASSERT_TRUE(admin->people->CreateApiKey(admin->context().get(), request, &reply).ok());
  Client client(daemon.address());
  client.key = reply.key();
  v1::WhoAmIResponse who;
  ASSERT_TRUE(client.people->WhoAmI(client.context().get(), {}, &who).ok());
  EXPECT_EQ(who.role(), v1::VIEWER);
  v1::DeleteApiKeyRequest remove;
  remove.set_name(reply.api_key().name());
  google::protobuf::Empty empty;
  const auto other = as("other");
  expect_refusal(other->people->DeleteApiKey(other->context().get(), remove, &empty),
                 StatusCode::NOT_FOUND, "KEY_NOT_FOUND");
  ASSERT_TRUE(admin->people->DeleteApiKey(admin->context().get(), remove, &empty).ok());
  expect_refusal(client.people->WhoAmI(client.context().get(), {}, &who),
                 StatusCode::UNAUTHENTICATED, "SIGN_IN_NEEDED");
}

TEST_F(PeopleApi, OwnPasswordNeedsTheOldOneExceptForAdmins) {
  const auto maker = as("maker");
  v1::SetPasswordRequest request;
  request.set_name("users/maker");
  request.set_new_password("battery staple");
  request.set_old_password("wrong password");
  v1::User user;
  expect_refusal(maker->people->SetPassword(maker->context().get(), request, &user),
                 StatusCode::PERMISSION_DENIED, "SIGN_IN_FAILED");
  request.set_name("users/other");
  request.set_old_password(kPassword);
  expect_refusal(maker->people->SetPassword(maker->context().get(), request, &user),
                 StatusCode::PERMISSION_DENIED, "ROLE_TOO_LOW");
  request.set_name("users/maker");
  ASSERT_TRUE(maker->people->SetPassword(maker->context().get(), request, &user).ok());
  const auto admin = as("admin");
  request.clear_old_password();
  request.set_new_password(kPassword);
  ASSERT_TRUE(admin->people->SetPassword(admin->context().get(), request, &user).ok());
  EXPECT_FALSE(sign_in("maker").session_token().empty());
}

TEST_F(PeopleApi, WrongPasswordsAreThrottledWithAWaitingTime) {
  Client client(daemon.address());
  v1::SignInRequest request;
  request.set_user("maker");
  request.set_password("wrong password");
  v1::SignInResponse reply;
  grpc::Status status;
  for (int i = 0; i < 4; ++i) {
    status = client.people->SignIn(client.context().get(), request, &reply);
  }
  expect_refusal(status, StatusCode::RESOURCE_EXHAUSTED, "TOO_MANY_ATTEMPTS");
  EXPECT_NE(status.error_details().find("RetryInfo"), std::string::npos);
  // Another user may sign in from the same address.
  EXPECT_FALSE(sign_in("other").session_token().empty());
}

TEST_F(PeopleApi, AuditLogNamesCallerAndMethod) {
  const auto maker = as("maker"), other = as("other"), admin = as("admin");
  const std::string name = maker->simulate("mesh").name();
  (void)cancel(*other, name);
  const auto created = audit(*admin, "JobService.CreateJob");
  ASSERT_EQ(created.size(), 1U);
  EXPECT_EQ(created[0].who(), "maker");
  EXPECT_EQ(created[0].object(), name);
  EXPECT_EQ(created[0].outcome(), "OK");
  EXPECT_TRUE(created[0].via().starts_with("key "));
  EXPECT_EQ(created[0].peer(), "127.0.0.1");
  const auto cancelled = audit(*admin, "JobService.CancelJob");
  ASSERT_EQ(cancelled.size(), 1U);
  EXPECT_EQ(cancelled[0].who(), "other");
  EXPECT_EQ(cancelled[0].object(), name);
  EXPECT_EQ(cancelled[0].outcome(), "PERMISSION_DENIED");
  EXPECT_EQ(audit(*admin, "PeopleService.CreateUser").size(), 5U);
  EXPECT_EQ(audit(*admin, "PeopleService.CreateUser").back().object(), "users/admin");
  EXPECT_TRUE(audit(*admin, "JobService.GetJob").empty());
  for (const v1::AuditEntry& entry : audit(*admin, "")) {
    EXPECT_EQ(entry.ShortDebugString().find(kPassword), std::string::npos);
  }
}

TEST_F(PeopleApi, AuditLogHasMotionsAndRefusals) {
  const auto rig = v1::RigService::NewStub(as("")->channel);
  const auto viewer = as("viewer"), operator_user = as("operator"), admin = as("admin");
  v1::MoveToRequest move;
  move.set_position_mm(12.5);
  v1::Rig reply;
  // The call fails because no rig is configured, not because of the role.
  EXPECT_FALSE(rig->MoveTo(operator_user->context().get(), move, &reply).ok());
  expect_refusal(rig->MoveTo(viewer->context().get(), move, &reply), StatusCode::PERMISSION_DENIED,
                 "ROLE_TOO_LOW");
  EXPECT_TRUE(rig->StopMotion(viewer->context().get(), {}, &reply).ok());
  expect_refusal(rig->StopMotion(as("")->context().get(), {}, &reply), StatusCode::UNAUTHENTICATED,
                 "SIGN_IN_NEEDED");
  const auto entries = audit(*admin, "RigService.");
  ASSERT_EQ(entries.size(), 3U);
  EXPECT_EQ(entries[0].what(), "RigService.StopMotion");
  EXPECT_EQ(entries[0].who(), "viewer");
  EXPECT_EQ(entries[0].outcome(), "OK");
  EXPECT_EQ(entries[1].who(), "viewer");
  EXPECT_EQ(entries[1].outcome(), "PERMISSION_DENIED");
  EXPECT_EQ(entries[2].who(), "operator");
}

TEST_F(PeopleApi, RepeatedRefusalsOfAFrequentCallAreRecordedOnce) {
  const auto rig = v1::RigService::NewStub(as("")->channel);
  const auto viewer = as("viewer"), admin = as("admin");
  for (int i = 0; i < 5; ++i) {
    v1::Rig reply;
    expect_refusal(rig->Jog(viewer->context().get(), {}, &reply), StatusCode::PERMISSION_DENIED,
                   "ROLE_TOO_LOW");
  }
  EXPECT_EQ(audit(*admin, "RigService.Jog").size(), 1U);
}

TEST_F(PeopleApi, UsersSurviveAKill) {
  daemon.kill();
  daemon.start();
  v1::WhoAmIResponse who;
  const auto maker = as("maker");
  ASSERT_TRUE(maker->people->WhoAmI(maker->context().get(), {}, &who).ok());
  EXPECT_EQ(who.user(), "maker");
}

TEST(PeopleFirst, WithoutUsersLoopbackCallersAreAdmin) {
  const TemporaryFolder folder;
  DaemonProcess daemon(folder.path(), DaemonProcess::fake());
  Client client(daemon.address(), "ann");
  v1::WhoAmIResponse who;
  ASSERT_TRUE(client.people->WhoAmI(client.context().get(), {}, &who).ok());
  EXPECT_EQ(who.user(), "ann");
  EXPECT_EQ(who.role(), v1::ADMIN);
  EXPECT_FALSE(who.accounts());
  v1::CreateUserRequest request;
  request.mutable_user()->set_name("users/bob");
  request.mutable_user()->set_role(v1::ADMIN);
  v1::User user;
  ASSERT_TRUE(client.people->CreateUser(client.context().get(), request, &user).ok());
  expect_refusal(client.people->WhoAmI(client.context().get(), {}, &who),
                 StatusCode::UNAUTHENTICATED, "SIGN_IN_NEEDED");
}

TEST(PeopleFirst, RequiredAccountsStartWithTheFirstLink) {
  const TemporaryFolder folder;
  auto options = DaemonProcess::fake();
  options.extra = "[people]\naccounts = \"required\"\n";
  options.arguments = {"--first-admin", "root"};
  DaemonProcess daemon(folder.path(), options);
  Client client(daemon.address());
  v1::WhoAmIResponse who;
  expect_refusal(client.people->WhoAmI(client.context().get(), {}, &who),
                 StatusCode::UNAUTHENTICATED, "SIGN_IN_NEEDED");
  const std::string words = daemon.printed();
  const std::size_t from = words.find("/sign-in#") + 9;
  v1::SignInRequest request;
  request.set_link_token(words.substr(from, words.find('\n', from) - from));
  v1::SignInResponse reply;
  ASSERT_TRUE(client.people->SignIn(client.context().get(), request, &reply).ok()) << words;
  EXPECT_EQ(reply.user().role(), v1::ADMIN);
  expect_refusal(client.people->SignIn(client.context().get(), request, &reply),
                 StatusCode::UNAUTHENTICATED, "SIGN_IN_FAILED");
  client.session = reply.session_token();
  v1::SetPasswordRequest set;
  set.set_name("users/root");
  set.set_new_password("correct horse");
  v1::User user;
  EXPECT_TRUE(client.people->SetPassword(client.context().get(), set, &user).ok());
  EXPECT_TRUE(user.has_password());
}

}  // namespace
}  // namespace hydroprint::tests
