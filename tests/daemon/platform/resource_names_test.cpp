#include "daemon/platform/resource_names.h"

#include <gtest/gtest.h>

namespace hydroprint::daemon {
namespace {

TEST(FileName, PlainNamesAndPathsOfPlainPartsPass) {
  for (const char* good :
       {"spot.obj", "textures/skin 1.png", "a/b/c", ".hidden", "tëxtüre.png", "...", "a..b"}) {
    EXPECT_TRUE(check_file_name("f", good)) << good;
  }
}

TEST(FileName, NamesThatLeaveTheFolderAreRefused) {
  using std::string_literals::operator""s;
  for (const std::string& bad :
       {""s, "/etc/passwd"s, "../x"s, "a/../b"s, "a/.."s, ".."s, "."s, "./a"s, "a//b"s, "a/"s,
        "a\\b"s, "a\nb"s, "a\0b"s, "\x7f"s, "-rf"s, "a/--out"s, std::string(256, 'a')}) {
    const Status status = check_file_name("f", bad);
    ASSERT_FALSE(status) << bad;
    EXPECT_EQ(status.error().reason, ErrorReason::NAME_INVALID);
    EXPECT_EQ(status.error().message.find('\n'), std::string::npos);
  }
}

TEST(Names, OnlyCanonicalNamesAreAccepted) {
  EXPECT_EQ(parse_job_name("jobs/7").value(), 7);
  for (const char* bad : {"jobs/", "jobs/0", "jobs/07", "jobs/-7", "jobs/7/", "job/7", "7",
                          "jobs/99999999999999999999", "jobs/7x"}) {
    EXPECT_FALSE(parse_job_name(bad)) << bad;
  }
  const std::string hash(64, 'a');
  EXPECT_EQ(parse_asset_name("assets/" + hash).value(), hash);
  EXPECT_FALSE(parse_asset_name("assets/" + std::string(64, 'A')));
  EXPECT_FALSE(parse_asset_name("assets/" + hash + "a"));
  EXPECT_FALSE(parse_asset_name("assets/../" + hash.substr(3)));
  EXPECT_FALSE(parse_upload_name("uploads/../../../../etc/passwd"));
  EXPECT_EQ(parse_artifact_name("jobs/3/artifacts/film.png")->second, "film.png");
  EXPECT_FALSE(parse_artifact_name("jobs/3/artifacts/../../x"));
  EXPECT_FALSE(parse_artifact_name("jobs/3/artifacts/"));
}

TEST(Names, UuidsHaveVersion4AndDiffer) {
  const std::string a = make_uuid(), b = make_uuid();
  EXPECT_EQ(a.size(), 36U);
  EXPECT_EQ(a[14], '4');
  EXPECT_NE(std::string("89ab").find(a[19]), std::string::npos);
  EXPECT_NE(a, b);
}

}  // namespace
}  // namespace hydroprint::daemon
