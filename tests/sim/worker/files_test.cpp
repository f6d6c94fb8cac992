#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include "sim/worker/motion_file.h"
#include "sim/worker/pose_file.h"
#include "sim/worker/sha256.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::worker {
namespace {

Result<Pose> pose(const std::string& json) {
  const testing::TemporaryFolder folder;
  return read_pose(folder.write("pose.json", json));
}

Result<waterline::Motion> motion(const std::string& csv) {
  const testing::TemporaryFolder folder;
  return read_motion(folder.write("motion.csv", csv));
}

TEST(PoseFile, QuaternionIsWxyzAndNormalised) {
  const auto read = pose(R"({"rotation_wxyz": [10, 0, 0, 10], "translation_mm": [1, 2, 3]})");
  ASSERT_TRUE(read) << read.error().message;
  // A quarter turn about z takes x to y.
  EXPECT_NEAR((*read * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(1, 3, 3)).norm(), 0, 1e-12);
}

TEST(PoseFile, WhatIsLeftOutIsNoMotion) {
  const auto read = pose("{}");
  ASSERT_TRUE(read);
  EXPECT_TRUE(read->isApprox(Pose::Identity()));
}

TEST(PoseFile, WhatIsNoPoseIsRefusedByFileAndKey) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {R"({"rotation": [1,0,0,0]})", "rotation: not a known key"},
      {R"({"rotation_wxyz": [0,0,0,0]})", "rotation_wxyz: too short"},
      {R"({"rotation_wxyz": [1e-9,0,0,0]})", "rotation_wxyz: too short"},
      {R"({"rotation_wxyz": [1,0,0]})", "rotation_wxyz: not a list of 4"},
      {R"({"rotation_wxyz": [1,0,0,"0"]})", "rotation_wxyz: not a list of 4"},
      {R"({"translation_mm": [1,2,3,4]})", "translation_mm: not a list of 3"},
      {R"({"translation_mm": [1,2,1e7]})", "translation_mm: beyond"},
      {R"({"translation_mm": [1,2,1e999]})", "pose.json: "},
      {R"([1,0,0,0])", "not a pose"},
      {"{\"rotation_wxyz\": [1,0,\n,0]}", "line 2, column 1"},
  };
  for (const auto& [json, text] : cases) {
    const auto read = pose(json);
    ASSERT_FALSE(read) << json;
    EXPECT_NE(read.error().message.find(text), std::string::npos) << read.error().message;
    EXPECT_NE(read.error().message.find("pose.json: "), std::string::npos);
    EXPECT_EQ(exit_status(read.error()), ExitStatus::kBadInput);
  }
}

TEST(PoseFile, QuaternionOfHugeNumbersStillHasItsDirection) {
  const auto read = pose(R"({"rotation_wxyz": [1e200, 0, 0, 1e200]})");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_NEAR((*read * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(0, 1, 0)).norm(), 0, 1e-12);
}

TEST(MotionFile, ImmersionAndOffsetCountFromTheFirstRow) {
  const auto read =
      motion("t_s, x_mm, y_mm, z_mm\r\n5,1,2,100\r\n6,1.5,2,95\r\n7, 1.5, 1, 95\r\n\r\n");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->rows.size(), 3u);
  EXPECT_EQ(read->rows[0].time_s, 0);
  EXPECT_EQ(read->rows[0].immersion_mm, 0);
  EXPECT_EQ(read->rows[0].offset_mm, Eigen::Vector2d(0, 0));
  EXPECT_EQ(read->rows[2].time_s, 2);
  EXPECT_EQ(read->rows[2].immersion_mm, 5);
  EXPECT_EQ(read->rows[2].offset_mm, Eigen::Vector2d(0.5, -1));
}

TEST(MotionFile, WhatIsNoWayDownIsRefusedByLine) {
  const std::string header = "t_s,x_mm,y_mm,z_mm\n";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "line 1: not the header"},
      {"0,0,0,0\n1,0,0,-1\n", "line 1: not the header"},
      {"t,x,y,z\n0,0,0,0\n1,0,0,-1\n", "line 1: not the header"},
      {header, "fewer than two rows"},
      {header + "0,0,0,0\n", "fewer than two rows"},
      {header + "0,0,0,0\n1,0,0\n", "line 3: not four finite numbers"},
      {header + "0,0,0,0\n1,0,0,-1,0\n", "line 3: not four finite numbers"},
      {header + "0,0,0,0\n1,0,nan,-1\n", "line 3: not four finite numbers"},
      {header + "0,0,0,0\n1,0,inf,-1\n", "line 3: not four finite numbers"},
      {header + "0,0,0,0\n1,0,1e999,-1\n", "line 3: not four finite numbers"},
      {header + "0,0,0,0\n\n1,0,0,-1\n", "line 3: not four finite numbers"},
      {header + "0,0,0,0\n1,0,0,-1\n1,0,0,-2\n", "line 4: t_s does not increase"},
      {header + "0,0,0,0\n1,0,0,-1\n2,0,0,-0.5\n", "line 4: z_mm rises"},
      {header + "0,0,0,0\n1,0,2e4,-1\n", "line 3: farther than"},
  };
  for (const auto& [csv, text] : cases) {
    const auto read = motion(csv);
    ASSERT_FALSE(read) << csv;
    EXPECT_NE(read.error().message.find(text), std::string::npos) << read.error().message;
    EXPECT_NE(read.error().message.find("motion.csv: "), std::string::npos);
    EXPECT_EQ(exit_status(read.error()), ExitStatus::kBadInput);
  }
}

TEST(MotionFile, AMillionRowsAreReadAndOneMoreIsRefused) {
  std::string csv = "t_s,x_mm,y_mm,z_mm\n";
  for (int i = 0; i < 1'000'000; ++i) csv += std::to_string(i) + ",0,0,0\n";
  const auto read = motion(csv);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->rows.size(), 1'000'000u);
  EXPECT_FALSE(motion(csv + "1000000,0,0,0\n"));
}

TEST(Sha256, MatchesThePublishedTestVectors) {
  const testing::TemporaryFolder folder;
  const auto empty = digest_file(folder.write("empty", ""));
  ASSERT_TRUE(empty);
  EXPECT_EQ(empty->sha256, "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(empty->size_bytes, 0u);
  const auto million = digest_file(folder.write("million", std::string(1'000'000, 'a')));
  ASSERT_TRUE(million);
  EXPECT_EQ(million->sha256, "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  EXPECT_EQ(million->size_bytes, 1'000'000u);
}

TEST(Sha256, OnlyRegularFilesAreRead) {
  EXPECT_EQ(digest_file("/no/such/file").error().code, Code::kNotFound);
  EXPECT_EQ(digest_file("/dev/zero").error().code, Code::kInvalidArgument);
  EXPECT_EQ(digest_file("/").error().code, Code::kInvalidArgument);
}

}  // namespace
}  // namespace hydroprint::worker
