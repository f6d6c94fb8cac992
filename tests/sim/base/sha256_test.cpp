#include "sim/base/sha256.h"

#include <gtest/gtest.h>

#include "sim/base/file_digest.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint {
namespace {

// FIPS 180-2, appendix B.1.
TEST(Sha256, OfAbcIsTheStandardsExampleHoweverItIsCut) {
  const std::string expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
  EXPECT_EQ(sha256("abc"), expected);
  Sha256 pieces;
  for (const char* piece : {"ab", "", "c"}) pieces.add(piece);
  EXPECT_EQ(pieces.finish(), expected);
}

TEST(FileDigest, MatchesThePublishedTestVectors) {
  const testing::TemporaryFolder folder;
  const auto empty = digest_file(folder.write("empty", ""));
  ASSERT_TRUE(empty);
  EXPECT_EQ(empty->sha256, "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(empty->size_bytes, 0);
  const auto million = digest_file(folder.write("million", std::string(1'000'000, 'a')));
  ASSERT_TRUE(million);
  EXPECT_EQ(million->sha256, "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  EXPECT_EQ(million->size_bytes, 1'000'000);
}

TEST(FileDigest, OnlyRegularFilesAreRead) {
  EXPECT_EQ(digest_file("/no/such/file").error().code, Code::kNotFound);
  EXPECT_EQ(digest_file("/dev/zero").error().code, Code::kInvalidArgument);
  EXPECT_EQ(digest_file("/").error().code, Code::kInvalidArgument);
}

TEST(FileDigest, EndsWhenCancelled) {
  const testing::TemporaryFolder folder;
  Context context;
  context.cancelled = [] { return true; };
  EXPECT_EQ(digest_file(folder.write("a", "b"), context).error().code, Code::kCancelled);
}

}  // namespace
}  // namespace hydroprint
