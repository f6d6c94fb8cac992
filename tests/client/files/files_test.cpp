#include "client/files/files.h"

#include <gtest/gtest.h>

#include <string>

#include "sim/base/sha256.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::client {
namespace {

TEST(ReadFile, ReadsEveryByteFromTheOffset) {
  const testing::TemporaryFolder folder;
  std::string content(200000, 'x');
  content[70000] = 'y';
  std::string read;
  ASSERT_TRUE(read_file(folder.write("a", content), 69999, [&](std::string_view bytes) {
    read += bytes;
    return true;
  }));
  EXPECT_EQ(read, content.substr(69999));
}

TEST(ReadFile, NamesAMissingFile) {
  const auto status = read_file("/no/such/file", 0, [](std::string_view) { return true; });
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, Code::kNotFound);
  EXPECT_NE(status.error().message.find("/no/such/file"), std::string::npos);
}

TEST(ReadFile, RefusesAFolder) {
  const testing::TemporaryFolder folder;
  const auto status = read_file(folder.path(), 0, [](std::string_view) { return true; });
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, Code::kInvalidArgument);
}

TEST(DigestFile, MatchesTheFilesBytes) {
  const testing::TemporaryFolder folder;
  const std::string content(100001, 'z');
  const auto result = digest_file(folder.write("a", content), {});
  ASSERT_TRUE(result);
  EXPECT_EQ(result->size_bytes, 100001);
  EXPECT_EQ(result->sha256, sha256(content));
}

TEST(DigestFile, EndsWhenStopped) {
  const testing::TemporaryFolder folder;
  std::stop_source stop;
  stop.request_stop();
  const auto result = digest_file(folder.write("a", "b"), stop.get_token());
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, Code::kCancelled);
}

TEST(ReadText, RefusesMoreThanItsLimit) {
  const testing::TemporaryFolder folder;
  const auto path = folder.write("a", "12345");
  EXPECT_EQ(read_text(path, 5).value(), "12345");
  EXPECT_FALSE(read_text(path, 4));
}

}  // namespace
}  // namespace hydroprint::client
