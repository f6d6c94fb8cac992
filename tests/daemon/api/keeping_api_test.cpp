// Ownership, quotas and retention, through the real daemon.
#include "daemon/store/database/database.h"
#include "hydroprint/v1/preview_service.grpc.pb.h"
#include "tests/daemon/api/people_support.h"

namespace hydroprint::tests {
namespace {

using grpc::StatusCode;

void expect_refused(const grpc::Status& status, StatusCode code, const std::string& reason) {
  EXPECT_EQ(status.error_code(), code) << status.error_message();
  EXPECT_EQ(error_info(status).reason(), reason) << status.error_message();
}

/// Calls that may be refused; each returns its status.
struct Asking {
  Client& client;

  grpc::Status start_upload(const std::string& bytes, v1::StartUploadResponse& reply) {
    v1::StartUploadRequest request;
    request.set_sha256(hash_of(bytes));
    request.set_size_bytes(static_cast<std::int64_t>(bytes.size()));
    return client.assets->StartUpload(client.context().get(), request, &reply);
  }
  grpc::Status get(const std::string& asset, v1::Asset& reply) {
    v1::GetAssetRequest request;
    request.set_name(asset);
    return client.assets->GetAsset(client.context().get(), request, &reply);
  }
  grpc::Status remove(const std::string& asset) {
    v1::DeleteAssetRequest request;
    request.set_name(asset);
    google::protobuf::Empty reply;
    return client.assets->DeleteAsset(client.context().get(), request, &reply);
  }
  std::vector<v1::Asset> list(const std::string& owner = "") {
    v1::ListAssetsRequest request;
    request.set_owner(owner);
    v1::ListAssetsResponse reply;
    EXPECT_TRUE(client.assets->ListAssets(client.context().get(), request, &reply).ok());
    return {reply.assets().begin(), reply.assets().end()};
  }
  grpc::Status create(const std::string& asset, v1::Job& job) {
    return client.create(simulate_request(asset), job);
  }
  grpc::Status preview(const std::string& asset) {
    v1::ComputePreviewRequest request;
    request.mutable_simulate()->mutable_mesh()->set_name("m.obj");
    request.mutable_simulate()->mutable_mesh()->set_asset(asset);
    v1::Preview reply;
    const auto stub = v1::PreviewService::NewStub(client.channel);
    return stub->ComputePreview(client.context().get(), request, &reply);
  }
  grpc::Status share(const std::string& job, bool shared) {
    v1::ShareJobRequest request;
    request.set_name(job);
    request.set_shared(shared);
    v1::Job reply;
    return client.jobs->ShareJob(client.context().get(), request, &reply);
  }
  grpc::Status pin(const std::string& name, bool pinned, v1::Job& job) {
    v1::PinJobRequest request;
    request.set_name(name);
    request.set_pinned(pinned);
    return client.jobs->PinJob(client.context().get(), request, &job);
  }
  grpc::Status usage(const std::string& owner, v1::Usage& reply) {
    v1::GetUsageRequest request;
    request.set_owner(owner);
    return client.people->GetUsage(client.context().get(), request, &reply);
  }
  v1::Usage usage() {
    v1::Usage reply;
    EXPECT_TRUE(usage("", reply).ok());
    return reply;
  }
};

class KeepingApi : public PeopleApi {
 protected:
  KeepingApi() {
    for (const char* const name : {"maker", "other", "operator", "admin", "viewer"}) {
      clients.push_back(as(name));
      asking.emplace(name, Asking{*clients.back()});
    }
  }
  Asking& operator[](const std::string& name) { return asking.at(name); }

  /// Moves the end times of finished jobs and the last uses of assets `days` into the past.
  void age(int days) {
    const std::string ms = std::to_string(days * 24LL * 3600 * 1000);
    const auto database = daemon::Database::open(state / "hydroprint.db", "").value();
    ASSERT_TRUE(database->run("UPDATE jobs SET keep_from_ms=keep_from_ms-" + ms));
    ASSERT_TRUE(database->run("UPDATE assets SET use_ms=use_ms-" + ms));
  }

  std::filesystem::path state = PeopleApi::daemon.state();
  std::vector<std::unique_ptr<Client>> clients;
  std::map<std::string, Asking> asking;
};

TEST_F(KeepingApi, HashAloneGivesNoAccessToAFile) {
  const std::string asset = as("maker")->upload("mesh");
  Asking& other = (*this)["other"];
  v1::Asset seen;
  v1::Job job;
  v1::StartUploadResponse started;
  expect_refused(other.get(asset, seen), StatusCode::NOT_FOUND, "ASSET_NOT_FOUND");
  expect_refused(other.create(asset, job), StatusCode::FAILED_PRECONDITION, "ASSET_MISSING");
  expect_refused(other.preview(asset), StatusCode::FAILED_PRECONDITION, "ASSET_MISSING");
  expect_refused(other.remove(asset), StatusCode::NOT_FOUND, "ASSET_NOT_FOUND");
  EXPECT_TRUE(other.list().empty());
  ASSERT_TRUE(other.start_upload("mesh", started).ok());
  EXPECT_TRUE(started.has_upload());  // a client that has the bytes may upload them
  for (const char* const name : {"operator", "admin"}) {
    ASSERT_TRUE((*this)[name].get(asset, seen).ok()) << name;
    EXPECT_EQ(seen.owners_size(), 1);
    EXPECT_EQ(seen.owners(0), "maker");
  }
  EXPECT_EQ(as("other")->upload("mesh"), asset);
  EXPECT_TRUE(other.create(asset, job).ok());
  ASSERT_EQ(other.list().size(), 1U);
  EXPECT_EQ(other.list().front().owners_size(), 1);  // other owners are hidden
  EXPECT_EQ((*this)["operator"].list().front().owners_size(), 2);
  EXPECT_EQ((*this)["operator"].list("viewer").size(), 0U);
}

TEST_F(KeepingApi, InputsOfASharedJobCanBeUsedByAll) {
  as("operator")->pause();  // jobs must not run: artifacts would count for their owners
  const auto maker = as("maker");
  const v1::Job job = maker->simulate("mesh");
  const std::string asset = job.simulate().mesh().asset();
  v1::Job made;
  EXPECT_FALSE((*this)["other"].create(asset, made).ok());
  ASSERT_TRUE((*this)["maker"].share(job.name(), true).ok());
  EXPECT_TRUE((*this)["other"].create(asset, made).ok());
  EXPECT_EQ((*this)["other"].usage().stored_bytes(), 0);  // the asset counts for its owner, maker
}

TEST_F(KeepingApi, OwnersGiveUpTheirAssetsAndOperatorsDeleteAny) {
  const std::string asset = as("maker")->upload("mesh");
  as("other")->upload("mesh");
  v1::Asset seen;
  ASSERT_TRUE((*this)["other"].remove(asset).ok());
  EXPECT_FALSE((*this)["other"].get(asset, seen).ok());
  ASSERT_TRUE((*this)["maker"].get(asset, seen).ok());
  ASSERT_TRUE((*this)["operator"].remove(asset).ok());
  expect_refused((*this)["maker"].get(asset, seen), StatusCode::NOT_FOUND, "ASSET_NOT_FOUND");
}

TEST_F(KeepingApi, BytesBeyondTheQuotaAreRefusedAndUsageIsReported) {
  const std::string large(3 << 20, 'a'), larger(3 << 20, 'b');
  const std::string asset = as("maker")->upload(large);
  Asking& maker = (*this)["maker"];
  EXPECT_EQ(maker.usage().stored_bytes(), 3 << 20);
  EXPECT_EQ(maker.usage().max_stored_bytes(), 4 << 20);
  EXPECT_EQ(maker.usage().owner(), "maker");
  v1::StartUploadResponse started;
  const auto refused = maker.start_upload(larger, started);
  expect_refused(refused, StatusCode::RESOURCE_EXHAUSTED, "QUOTA_EXCEEDED");
  EXPECT_EQ(
      refused.error_message(),
      "maker uses 3 of 4 MiB, and the new file needs 3 MiB more; delete jobs (hydroprint list "
      "--mine, hydroprint delete) or files (hydroprint assets list, hydroprint assets delete)");
  EXPECT_TRUE((*this)["other"].start_upload(larger, started).ok());
  v1::Usage usage;
  expect_refused((*this)["other"].usage("maker", usage), StatusCode::PERMISSION_DENIED,
                 "ROLE_TOO_LOW");
  ASSERT_TRUE((*this)["admin"].usage("maker", usage).ok());
  EXPECT_EQ(usage.stored_bytes(), 3 << 20);
  ASSERT_TRUE(maker.remove(asset).ok());
  EXPECT_EQ(maker.usage().stored_bytes(), 0);
  EXPECT_TRUE(maker.start_upload(larger, started).ok());
}

TEST_F(KeepingApi, QueuedJobsPerOwnerAreLimited) {
  as("operator")->pause();
  const std::string asset = as("maker")->upload("mesh");
  v1::Job job;
  for (int i = 0; i < 4; ++i) ASSERT_TRUE((*this)["maker"].create(asset, job).ok());
  expect_refused((*this)["maker"].create(asset, job), StatusCode::RESOURCE_EXHAUSTED,
                 "QUOTA_EXCEEDED");
  EXPECT_EQ((*this)["maker"].usage().queued_jobs(), 4);
  EXPECT_EQ((*this)["maker"].usage().max_queued_jobs(), 4);
  EXPECT_TRUE((*this)["other"].create(as("other")->upload("mesh"), job).ok());
  as("maker")->cancel("jobs/1");
  EXPECT_TRUE((*this)["maker"].create(asset, job).ok());
}

TEST_F(KeepingApi, OldJobsAndFilesAreDeletedUnlessPinned) {
  const auto maker = as("maker");
  const std::string unused = maker->upload("unused");
  const v1::Job old = maker->wait_for_end(maker->simulate("old").name());
  const v1::Job pinned = maker->wait_for_end(maker->simulate("pinned").name());
  EXPECT_EQ(old.purge_time().seconds() - old.end_time().seconds(), 30 * 24 * 3600);
  v1::Job job;
  expect_refused((*this)["other"].pin(pinned.name(), true, job), StatusCode::PERMISSION_DENIED,
                 "NOT_YOURS");
  ASSERT_TRUE((*this)["maker"].pin(pinned.name(), true, job).ok());
  EXPECT_TRUE(job.pinned());
  EXPECT_FALSE(job.has_purge_time());
  EXPECT_GT((*this)["maker"].usage().pinned_bytes(), 0);
  PeopleApi::daemon.terminate();
  age(31);
  PeopleApi::daemon.start();
  const auto again = as("maker");
  v1::GetJobRequest request;
  request.set_name(old.name());
  expect_refused(again->jobs->GetJob(again->context().get(), request, &job), StatusCode::NOT_FOUND,
                 "JOB_NOT_FOUND");
  EXPECT_EQ(again->job(pinned.name()).state(), v1::Job::SUCCEEDED);
  EXPECT_FALSE(again->download(pinned.name() + "/artifacts/film.png").empty());
  Asking after{*again};
  v1::Asset asset;
  expect_refused(after.get(unused, asset), StatusCode::NOT_FOUND, "ASSET_NOT_FOUND");
  EXPECT_TRUE(after.get(pinned.simulate().mesh().asset(), asset).ok());
  EXPECT_NE(PeopleApi::daemon.log().find("event=job_deleted job=1"), std::string::npos);
  EXPECT_NE(PeopleApi::daemon.log().find("event=asset_deleted"), std::string::npos);
}

TEST_F(KeepingApi, AuditLogSurvivesAKillAfterTheAnswer) {
  constexpr int kChanges = 10;
  {
    const auto admin = as("admin");
    for (int i = 0; i < kChanges; ++i) {
      v1::UpdateUserRequest request;
      request.set_name("users/viewer");
      request.set_disabled(i % 2 == 0);
      v1::User user;
      ASSERT_TRUE(admin->people->UpdateUser(admin->context().get(), request, &user).ok());
    }
    PeopleApi::daemon.kill();
  }
  PeopleApi::daemon.start();
  const auto admin = as("admin");
  v1::ListAuditRequest request;
  request.set_what("PeopleService.UpdateUser");
  v1::ListAuditResponse reply;
  ASSERT_TRUE(admin->people->ListAudit(admin->context().get(), request, &reply).ok());
  EXPECT_EQ(reply.entries_size(), kChanges);
}

TEST_F(KeepingApi, NameOfADeletedUserIsReserved) {
  const auto admin = as("admin");
  const std::string name = as("maker")->simulate("mesh").name();
  v1::DeleteUserRequest leaves;
  leaves.set_name("users/maker");
  google::protobuf::Empty empty;
  ASSERT_TRUE(admin->people->DeleteUser(admin->context().get(), leaves, &empty).ok());
  v1::CreateUserRequest comes;
  comes.mutable_user()->set_name("users/maker");
  comes.mutable_user()->set_role(v1::MAKER);
  comes.set_password(kPassword);
  v1::User user;
  expect_refused(admin->people->CreateUser(admin->context().get(), comes, &user),
                 StatusCode::FAILED_PRECONDITION, "USER_NAME_USED");
  comes.set_returns(true);  // confirms that the new user is the same person
  ASSERT_TRUE(admin->people->CreateUser(admin->context().get(), comes, &user).ok());
  keys["maker"] = key_of("maker");
  EXPECT_TRUE(as("maker")->job(name).simulate().has_mesh());
}

}  // namespace
}  // namespace hydroprint::tests
