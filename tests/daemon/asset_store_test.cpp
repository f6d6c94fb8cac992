#include <sys/stat.h>

#include "tests/daemon/store_fixture.h"

namespace hydroprint::daemon {
namespace {

class AssetStoreTest : public StoreTest {
 protected:
  Upload begin(const std::string& bytes, const RequestKey& key = {}) {
    const Upload wanted{"", sha256(bytes), static_cast<std::int64_t>(bytes.size()), 0, "x/y", 0};
    return std::get<Upload>(assets->start(wanted, "ann", key).value());
  }
  Result<AssetOrUpload> send(const std::string& id, std::int64_t offset, const std::string& bytes) {
    HP_ASSIGN_OR_RETURN(const auto writer, UploadWriter::open(*assets, id));
    HP_RETURN_IF_ERROR(writer->append(offset, bytes));
    return writer->finish();
  }
  Asset put(const std::string& bytes) {
    return std::get<Asset>(send(begin(bytes).id, 0, bytes).value());
  }
};

TEST_F(AssetStoreTest, VerifiedBytesBecomeAnAssetThatIsNotUploadedAgain) {
  const Asset asset = put("mesh");
  EXPECT_EQ(asset.sha256, sha256("mesh"));
  EXPECT_EQ(sha256_of_file(layout.asset(asset.sha256)).value(), asset.sha256);
  const auto again = assets->start({"", asset.sha256, 4, 0, "", 0}, "bob", {});
  EXPECT_EQ(std::get<Asset>(again.value()).sha256, asset.sha256);
}

TEST_F(AssetStoreTest, AFileOfTheDaemonsOwnBecomesAnAssetThatOutlivesIt) {
  const auto file = layout.root / "film.png";
  std::ofstream(file) << "film";
  for (int i = 0; i < 2; ++i) {
    const auto asset = assets->adopt(file, {sha256("film"), 4, "image/png", 0});
    ASSERT_TRUE(asset) << asset.error().message;
    EXPECT_EQ(asset->media_type, "image/png");
  }
  std::filesystem::remove(file);
  open();
  EXPECT_TRUE(assets->asset(sha256("film")));
  EXPECT_EQ(sha256_of_file(layout.asset(sha256("film"))).value(), sha256("film"));
}

TEST_F(AssetStoreTest, WrongHashLeavesNothing) {
  const Upload upload = begin("mesh");
  const auto result = send(upload.id, 0, "mess");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().reason, "ASSET_HASH_MISMATCH");
  EXPECT_EQ(assets->upload(upload.id).error().reason, "UPLOAD_NOT_FOUND");
  EXPECT_EQ(assets->asset(sha256("mesh")).error().reason, "ASSET_NOT_FOUND");
  EXPECT_FALSE(std::filesystem::exists(layout.upload(upload.id)));
}

TEST_F(AssetStoreTest, BrokenUploadGoesOnWhereItWasAlsoAfterARestart) {
  const Upload upload = begin("some mesh");
  EXPECT_EQ(std::get<Upload>(send(upload.id, 0, "some ").value()).received_bytes, 5);
  open();
  EXPECT_EQ(assets->upload(upload.id)->received_bytes, 5);
  const auto gap = send(upload.id, 6, "esh");
  ASSERT_FALSE(gap);
  EXPECT_EQ(gap.error().reason, "OFFSET_MISMATCH");
  EXPECT_EQ(gap.error().metadata.at("expected_offset"), "5");
  EXPECT_TRUE(std::holds_alternative<Asset>(send(upload.id, 5, "mesh").value()));
}

TEST_F(AssetStoreTest, MoreThanAnnouncedOrAllowedIsRefused) {
  const Upload upload = begin("mesh");
  EXPECT_EQ(send(upload.id, 0, "mesh+").error().reason, "ASSET_TOO_LARGE");
  const auto large = assets->start({"", std::string(64, 'a'), 101, 0, "", 0}, "ann", {});
  ASSERT_FALSE(large);
  EXPECT_EQ(large.error().code, Code::kResourceExhausted);
  EXPECT_EQ(large.error().metadata.at("max_bytes"), "100");
}

TEST_F(AssetStoreTest, OnlyOneCallSendsToAnUpload) {
  const Upload upload = begin("mesh");
  auto first = UploadWriter::open(*assets, upload.id);
  ASSERT_TRUE(first);
  EXPECT_EQ(UploadWriter::open(*assets, upload.id).error().reason, "UPLOAD_BUSY");
  first->reset();
  EXPECT_TRUE(UploadWriter::open(*assets, upload.id));
}

TEST_F(AssetStoreTest, UploadsAreLimitedInNumberAndTime) {
  begin("1");
  begin("2");
  const Upload third = begin("3");
  const Upload wanted{"", sha256("4"), 1, 0, "", 0};
  EXPECT_EQ(assets->start(wanted, "ann", {}).error().reason, "UPLOADS_FULL");
  now_ms += 1000;
  EXPECT_EQ(assets->upload(third.id).error().reason, "UPLOAD_NOT_FOUND");
  ASSERT_TRUE(assets->purge());
  EXPECT_TRUE(assets->start(wanted, "ann", {}));
}

TEST_F(AssetStoreTest, RepeatedRequestGetsTheSameUpload) {
  const RequestKey key{"StartUpload", "id", "x"};
  EXPECT_EQ(begin("mesh", key).id, begin("mesh", key).id);
  EXPECT_NE(begin("mesh").id, begin("mesh", key).id);
}

TEST_F(AssetStoreTest, FullDiskIsRefusedBeforeAnythingIsSent) {
  asset_options.min_free_bytes = 1LL << 60;
  open();
  const auto refused = assets->start({"", std::string(64, 'a'), 1, 0, "", 0}, "ann", {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().reason, "DISK_FULL");
}

TEST_F(AssetStoreTest, AssetOfAnUnfinishedJobStays) {
  const Asset asset = put("mesh");
  NewJob made;
  made.work.verb = "simulate";
  made.work.inputs = {{"m.obj", asset.sha256}};
  const Job job = jobs->create(made, {}).value();
  EXPECT_EQ(assets->remove(asset.sha256).error().reason, "STATE_FORBIDS");
  ASSERT_TRUE(jobs->cancel(job.id));
  EXPECT_TRUE(assets->remove(asset.sha256));
  EXPECT_FALSE(std::filesystem::exists(layout.asset(asset.sha256)));
  EXPECT_EQ(assets->remove(asset.sha256).error().reason, "ASSET_NOT_FOUND");
}

TEST_F(AssetStoreTest, StartAfterACrashMakesRowsAndFilesAgree) {
  const Asset kept = put("kept"), lost = put("lost");
  std::filesystem::remove(layout.asset(lost.sha256));
  std::filesystem::create_directories(layout.asset(sha256("junk")).parent_path());
  std::ofstream(layout.asset(sha256("junk"))) << "junk";
  std::ofstream(layout.upload("0123")) << "nobody's";
  // Killed between the rename and the row: the bytes were verified and must not be lost.
  const Upload upload = begin("renamed");
  std::filesystem::create_directories(layout.asset(upload.sha256).parent_path());
  std::ofstream(layout.asset(upload.sha256)) << "renamed";
  open();
  EXPECT_TRUE(assets->asset(kept.sha256));
  EXPECT_FALSE(assets->asset(lost.sha256));
  EXPECT_FALSE(std::filesystem::exists(layout.asset(sha256("junk"))));
  EXPECT_FALSE(std::filesystem::exists(layout.upload("0123")));
  EXPECT_TRUE(assets->asset(upload.sha256));
  EXPECT_FALSE(assets->upload(upload.id));
}

TEST_F(AssetStoreTest, EmptyFileIsAnAssetToo) {
  EXPECT_EQ(put("").size_bytes, 0);
  EXPECT_EQ(assets->list("", 10)->size(), 1U);
}

}  // namespace
}  // namespace hydroprint::daemon
