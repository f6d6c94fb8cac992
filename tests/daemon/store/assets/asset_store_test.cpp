#include <sys/stat.h>

#include "tests/daemon/store/store_fixture.h"

namespace hydroprint::daemon {
namespace {

class AssetStoreTest : public StoreTest {
 protected:
  Result<AssetOrUpload> ask(const std::string& bytes, const AssetUser& user,
                            const RequestKey& key = {}) {
    return uploads->start({"", sha256(bytes), static_cast<std::int64_t>(bytes.size()), 0, "x/y", 0},
                          user, key);
  }
  Upload begin(const std::string& bytes, const RequestKey& key = {},
               const std::string& owner = "ann") {
    return std::get<Upload>(ask(bytes, {owner}, key).value());
  }
  Result<AssetOrUpload> send(const std::string& id, std::int64_t offset, const std::string& bytes,
                             const std::string& owner = "ann") {
    HP_ASSIGN_OR_RETURN(const auto writer, UploadWriter::open(*uploads, id, owner));
    HP_RETURN_IF_ERROR(writer->append(offset, bytes));
    return writer->finish();
  }
  Asset put(const std::string& bytes, const std::string& owner = "ann") {
    return std::get<Asset>(send(begin(bytes, {}, owner).id, 0, bytes, owner).value());
  }
  /// Creates a job with this asset as input.
  Job made_of(const Asset& asset, const std::string& owner) {
    NewJob definition;
    definition.owner = owner;
    definition.work.verb = "simulate";
    definition.work.inputs = {{"m.obj", asset.sha256}};
    return jobs->create(definition, {}).value();
  }
  [[nodiscard]] bool may(const std::string& owner, const Asset& asset) {
    const bool sees = assets->asset_for(asset.sha256, {owner}).has_value();
    EXPECT_EQ(check_may_use(*database, {{"m.obj", asset.sha256}}, {owner}).has_value(), sees);
    return sees;
  }
  [[nodiscard]] std::int64_t stored(const std::string& owner) {
    return usage_of(*database, owner)->stored_bytes;
  }

  const AssetUser ann{"ann"}, bob{"bob"}, oper{"oper", true};
};

TEST_F(AssetStoreTest, VerifiedBytesBecomeAnAssetAndAreNotUploadedAgain) {
  const Asset asset = put("mesh");
  EXPECT_EQ(asset.sha256, sha256("mesh"));
  EXPECT_EQ(sha256_of_file(layout.asset(asset.sha256)).value(), asset.sha256);
  EXPECT_EQ(std::get<Asset>(ask("mesh", ann).value()).sha256, asset.sha256);
}

TEST_F(AssetStoreTest, HashAloneRequiresAnUpload) {
  const Asset asset = put("mesh");
  EXPECT_FALSE(may("bob", asset));
  EXPECT_EQ(assets->asset_for(asset.sha256, bob).error().reason, ErrorReason::ASSET_NOT_FOUND);
  EXPECT_EQ(check_may_use(*database, {{"m.obj", asset.sha256}}, bob).error().reason,
            ErrorReason::ASSET_MISSING);
  EXPECT_EQ(check_may_use(*database, {{"m.obj", asset.sha256}}, bob).error().message,
            check_may_use(*database, {{"m.obj", asset.sha256}}, {"eve"}).error().message);
  const Upload upload = begin("mesh", {}, "bob");
  EXPECT_FALSE(send(upload.id, 0, "mess", "bob"));
  EXPECT_FALSE(may("bob", asset));
  put("mesh", "bob");
  EXPECT_TRUE(may("bob", asset));
  EXPECT_TRUE(may("ann", asset));
  EXPECT_EQ(assets->asset_for(asset.sha256, bob)->owners, std::vector<std::string>{"bob"});
  EXPECT_EQ(assets->asset_for(asset.sha256, oper)->owners,
            (std::vector<std::string>{"ann", "bob"}));
  EXPECT_EQ(sha256_of_file(layout.asset(asset.sha256)).value(), asset.sha256);
}

TEST_F(AssetStoreTest, UploadBelongsToItsOwner) {
  const Upload upload = begin("mesh");
  EXPECT_EQ(uploads->get(upload.id, "bob").error().reason, ErrorReason::UPLOAD_NOT_FOUND);
  EXPECT_EQ(send(upload.id, 0, "mesh", "bob").error().reason, ErrorReason::UPLOAD_NOT_FOUND);
  EXPECT_TRUE(send(upload.id, 0, "mesh"));
}

TEST_F(AssetStoreTest, InputsOfASharedJobAreUsableWhileItIsShared) {
  const Asset asset = put("mesh");
  const Job job = made_of(asset, "ann");
  EXPECT_FALSE(may("bob", asset));
  ASSERT_TRUE(jobs->share(job.id, true));
  EXPECT_TRUE(may("bob", asset));
  EXPECT_EQ(assets->remove(asset.sha256, bob).error().reason,
            ErrorReason::ASSET_NOT_FOUND);  // the asset has no owner bob
  ASSERT_TRUE(jobs->share(job.id, false));
  EXPECT_FALSE(may("bob", asset));
}

TEST_F(AssetStoreTest, AssetEndsWithItsLastOwnerUnlessAJobUsesIt) {
  const Asset asset = put("mesh");
  put("mesh", "bob");
  EXPECT_EQ(stored("bob"), 4);
  ASSERT_TRUE(assets->remove(asset.sha256, bob));
  EXPECT_EQ(stored("bob"), 0);
  EXPECT_FALSE(may("bob", asset));
  EXPECT_TRUE(may("ann", asset));
  const Job job = made_of(asset, "ann"), others = made_of(asset, "bob");
  EXPECT_EQ(assets->remove(asset.sha256, ann).error().reason, ErrorReason::STATE_FORBIDS);
  EXPECT_EQ(stored("ann"), 4);  // the asset still counts for ann
  ASSERT_TRUE(jobs->cancel(job.id));
  ASSERT_TRUE(jobs->remove(job.id));
  ASSERT_TRUE(assets->remove(asset.sha256, ann));
  EXPECT_FALSE(may("ann", asset));
  EXPECT_TRUE(may("bob", asset));  // because of the job of bob
  EXPECT_TRUE(std::filesystem::exists(layout.asset(asset.sha256)));
  const Asset other = put("other");
  ASSERT_TRUE(assets->remove(other.sha256, ann));
  EXPECT_FALSE(std::filesystem::exists(layout.asset(other.sha256)));
}

TEST_F(AssetStoreTest, RestartGrantsNoAssetsWithoutAnUpload) {
  const Asset asset = put("mesh");
  const Upload upload = begin("mesh", {}, "bob");  // bob sends no bytes
  open();
  EXPECT_FALSE(may("bob", asset));
  EXPECT_EQ(uploads->get(upload.id, "bob")->received_bytes, 0);
}

TEST_F(AssetStoreTest, OwnersListTheirAssetsAndOperatorsListAll) {
  const Asset mesh = put("mesh"), other = put("other", "bob");
  ASSERT_EQ(assets->list("", 10, "ann")->size(), 1U);
  EXPECT_EQ(assets->list("", 10, "ann")->front().sha256, mesh.sha256);
  EXPECT_EQ(assets->list("", 10, "")->size(), 2U);
}

TEST_F(AssetStoreTest, QuotaIsCheckedAtTheStartAndEndOfAnUpload) {
  upload_options.quota.max_stored_bytes = 10;
  open();
  put("12345");
  const auto refused = ask("123456", ann);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::kResourceExhausted);
  EXPECT_EQ(refused.error().reason, ErrorReason::QUOTA_EXCEEDED);
  EXPECT_EQ(refused.error().metadata.at("quota"), "bytes");
  EXPECT_EQ(refused.error().metadata.at("used"), "5");
  EXPECT_EQ(refused.error().metadata.at("allowed"), "10");
  EXPECT_TRUE(ask("123456", bob));  // the quota applies to each owner separately
  // Open uploads count, so that several simultaneous uploads cannot exceed the quota.
  const Upload upload = begin("abcde");
  EXPECT_FALSE(ask("x", ann));
  // The artifacts of a job use up the quota before the upload ends.
  const Job job = add();
  complete(job.id);
  const auto late = send(upload.id, 0, "abcde");
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error().reason, ErrorReason::QUOTA_EXCEEDED);
  EXPECT_FALSE(uploads->get(upload.id, "ann"));
  EXPECT_FALSE(std::filesystem::exists(layout.upload(upload.id)));
  EXPECT_FALSE(std::filesystem::exists(layout.asset(sha256("abcde"))));
  ASSERT_TRUE(jobs->remove(job.id));
  put("abcde");
}

TEST_F(AssetStoreTest, UnusedAssetsAreDeletedAfterTheirRetention) {
  keep_unused_ms = 1000;
  open();
  const Asset used = put("used"), unused = put("unused"), asked = put("asked");
  const Job job = made_of(used, "ann");
  now_ms += 999;
  ASSERT_TRUE(asset_retention->purge());
  EXPECT_TRUE(may("ann", unused));
  EXPECT_TRUE(ask("asked", ann));  // a new request for the upload restarts the retention
  now_ms += 1;
  ASSERT_TRUE(asset_retention->purge());
  EXPECT_FALSE(select_asset(*database, unused.sha256));
  EXPECT_FALSE(std::filesystem::exists(layout.asset(unused.sha256)));
  EXPECT_EQ(stored("ann"), 9);
  EXPECT_TRUE(may("ann", asked));
  EXPECT_TRUE(may("ann", used));
  ASSERT_TRUE(jobs->cancel(job.id));
  ASSERT_TRUE(jobs->remove(job.id));
  ASSERT_TRUE(asset_retention->purge());
  EXPECT_FALSE(select_asset(*database, used.sha256));
}

TEST_F(AssetStoreTest, ZeroDaysKeepsForEver) {
  keep_unused_ms = 0;
  open();
  const Asset asset = put("mesh");
  now_ms += 1LL << 50;
  ASSERT_TRUE(asset_retention->purge());
  EXPECT_TRUE(may("ann", asset));
}

TEST_F(AssetStoreTest, AdoptedFileOutlivesItsSource) {
  const auto file = layout.root / "film.png";
  std::ofstream(file) << "film";
  for (int i = 0; i < 2; ++i) {
    const auto asset = assets->adopt(file, {sha256("film"), 4, "image/png", 0});
    ASSERT_TRUE(asset) << asset.error().message;
    EXPECT_EQ(asset->media_type, "image/png");
  }
  std::filesystem::remove(file);
  open();
  EXPECT_TRUE(select_asset(*database, sha256("film")));
  EXPECT_EQ(sha256_of_file(layout.asset(sha256("film"))).value(), sha256("film"));
}

TEST_F(AssetStoreTest, WrongHashDeletesTheUpload) {
  const Upload upload = begin("mesh");
  const auto result = send(upload.id, 0, "mess");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().reason, ErrorReason::ASSET_HASH_MISMATCH);
  EXPECT_EQ(uploads->get(upload.id, "ann").error().reason, ErrorReason::UPLOAD_NOT_FOUND);
  EXPECT_EQ(select_asset(*database, sha256("mesh")).error().reason, ErrorReason::ASSET_NOT_FOUND);
  EXPECT_FALSE(std::filesystem::exists(layout.upload(upload.id)));
}

TEST_F(AssetStoreTest, BrokenUploadResumesEvenAfterARestart) {
  const Upload upload = begin("some mesh");
  EXPECT_EQ(std::get<Upload>(send(upload.id, 0, "some ").value()).received_bytes, 5);
  open();
  EXPECT_EQ(uploads->get(upload.id, "ann")->received_bytes, 5);
  const auto gap = send(upload.id, 6, "esh");
  ASSERT_FALSE(gap);
  EXPECT_EQ(gap.error().reason, ErrorReason::OFFSET_MISMATCH);
  EXPECT_EQ(gap.error().metadata.at("expected_offset"), "5");
  EXPECT_TRUE(std::holds_alternative<Asset>(send(upload.id, 5, "mesh").value()));
}

TEST_F(AssetStoreTest, MoreThanAnnouncedOrAllowedIsRefused) {
  const Upload upload = begin("mesh");
  EXPECT_EQ(send(upload.id, 0, "mesh+").error().reason, ErrorReason::ASSET_TOO_LARGE);
  const auto large = uploads->start({"", std::string(64, 'a'), 101, 0, "", 0}, ann, {});
  ASSERT_FALSE(large);
  EXPECT_EQ(large.error().code, Code::kResourceExhausted);
  EXPECT_EQ(large.error().metadata.at("max_bytes"), "100");
}

TEST_F(AssetStoreTest, OneCallAtATimeWritesAnUpload) {
  const Upload upload = begin("mesh");
  auto first = UploadWriter::open(*uploads, upload.id, "ann");
  ASSERT_TRUE(first);
  EXPECT_EQ(UploadWriter::open(*uploads, upload.id, "ann").error().reason,
            ErrorReason::UPLOAD_BUSY);
  first->reset();
  EXPECT_TRUE(UploadWriter::open(*uploads, upload.id, "ann"));
}

TEST_F(AssetStoreTest, UploadsAreLimitedInNumberAndTime) {
  begin("1");
  begin("2");
  const Upload third = begin("3");
  const Upload wanted{"", sha256("4"), 1, 0, "", 0};
  EXPECT_EQ(uploads->start(wanted, ann, {}).error().reason, ErrorReason::UPLOADS_FULL);
  now_ms += 1000;
  EXPECT_EQ(uploads->get(third.id, "ann").error().reason, ErrorReason::UPLOAD_NOT_FOUND);
  ASSERT_TRUE(asset_retention->purge());
  EXPECT_TRUE(uploads->start(wanted, ann, {}));
}

TEST_F(AssetStoreTest, RepeatedRequestReturnsTheSameUpload) {
  const RequestKey key{"StartUpload", "id", "x"};
  EXPECT_EQ(begin("mesh", key).id, begin("mesh", key).id);
  EXPECT_NE(begin("mesh").id, begin("mesh", key).id);
}

TEST_F(AssetStoreTest, FullDiskIsReportedBeforeAnyUpload) {
  upload_options.min_free_bytes = 1LL << 60;
  open();
  const auto refused = uploads->start({"", std::string(64, 'a'), 1, 0, "", 0}, ann, {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().reason, ErrorReason::DISK_FULL);
}

TEST_F(AssetStoreTest, AssetOfAnUnfinishedJobStays) {
  const Asset asset = put("mesh");
  NewJob definition;
  definition.work.verb = "simulate";
  definition.work.inputs = {{"m.obj", asset.sha256}};
  const Job job = jobs->create(definition, {}).value();
  EXPECT_EQ(assets->remove(asset.sha256, oper).error().reason, ErrorReason::STATE_FORBIDS);
  ASSERT_TRUE(jobs->cancel(job.id));
  EXPECT_TRUE(assets->remove(asset.sha256, oper));
  EXPECT_FALSE(std::filesystem::exists(layout.asset(asset.sha256)));
  EXPECT_EQ(assets->remove(asset.sha256, oper).error().reason, ErrorReason::ASSET_NOT_FOUND);
}

TEST_F(AssetStoreTest, RestartSetsUnknownFilesAsideAndAdoptsVerifiedOnes) {
  const Asset kept = put("kept");
  std::filesystem::create_directories(layout.asset(sha256("junk")).parent_path());
  std::ofstream(layout.asset(sha256("junk"))) << "junk";
  std::ofstream(layout.upload("0123")) << "nobody's";
  // As if the daemon was killed after it renamed the file and before it wrote the row: the verified
  // bytes must not be lost.
  const Upload upload = begin("renamed");
  std::filesystem::create_directories(layout.asset(upload.sha256).parent_path());
  std::ofstream(layout.asset(upload.sha256)) << "renamed";
  open();
  EXPECT_TRUE(select_asset(*database, kept.sha256));
  EXPECT_FALSE(std::filesystem::exists(layout.asset(sha256("junk"))));
  EXPECT_FALSE(std::filesystem::exists(layout.upload("0123")));
  EXPECT_EQ(set_aside(), (std::multiset<std::string>{"junk", "nobody's"}));
  EXPECT_TRUE(select_asset(*database, upload.sha256));
  EXPECT_FALSE(uploads->get(upload.id, "ann"));
}

TEST_F(AssetStoreTest, MissingAssetFolderDeletesNothing) {
  const Asset asset = put("mesh");
  std::filesystem::rename(layout.assets(), layout.root / "elsewhere");
  open();
  EXPECT_TRUE(may("ann", asset));
  std::filesystem::remove_all(layout.assets());
  std::filesystem::rename(layout.root / "elsewhere", layout.assets());
  open();
  EXPECT_EQ(sha256_of_file(layout.asset(asset.sha256)).value(), asset.sha256);
  EXPECT_TRUE(may("ann", asset));
}

TEST_F(AssetStoreTest, AssetWithAMissingFileCanBeUploadedAgain) {
  const Asset asset = put("mesh");
  std::filesystem::remove(layout.asset(asset.sha256));
  open();
  EXPECT_EQ(put("mesh").sha256, asset.sha256);
  EXPECT_EQ(sha256_of_file(layout.asset(asset.sha256)).value(), asset.sha256);
}

TEST_F(AssetStoreTest, MissingDatabaseDeletesNothing) {
  put("mesh");
  complete(add("1").id);
  begin("part");
  std::ofstream(layout.upload("0123")) << "part";
  close();
  for (const char* const end : {"", "-wal", "-shm"}) {
    std::filesystem::remove(layout.database().string() + end);
  }
  open();
  EXPECT_EQ(set_aside(), (std::multiset<std::string>{"mesh", "film", "part"}));
}

TEST_F(AssetStoreTest, OlderDatabaseDeletesNothing) {
  complete(add("1").id, "early");
  const Job running = add("2");
  close();
  std::filesystem::copy_file(layout.database(), layout.root / "older.db");
  open();
  put("mesh");
  complete(running.id, "late");
  complete(add("3").id, "last");
  close();
  for (const char* const end : {"", "-wal", "-shm"}) {
    std::filesystem::remove(layout.database().string() + end);
  }
  std::filesystem::rename(layout.root / "older.db", layout.database());
  open();
  EXPECT_EQ(set_aside(), (std::multiset<std::string>{"mesh", "late", "last"}));
  EXPECT_TRUE(std::filesystem::exists(layout.artifacts(1) / "film.png"));
}

TEST_F(AssetStoreTest, EmptyFileIsAnAsset) {
  EXPECT_EQ(put("").size_bytes, 0);
  EXPECT_EQ(assets->list("", 10, "")->size(), 1U);
}

}  // namespace
}  // namespace hydroprint::daemon
