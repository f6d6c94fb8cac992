#include "sim/base/pose_file.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace hydroprint {
namespace {

Result<Pose> pose(const std::string& json) {
  const testing::TemporaryFolder folder;
  return read_pose_file(folder.write("pose.json", json)).map([](const PoseFile& file) {
    return file.pose();
  });
}

TEST(PoseFile, QuaternionIsWxyzAndNormalised) {
  const auto read = pose(R"({"rotation_wxyz": [10, 0, 0, 10], "translation_mm": [1, 2, 3]})");
  ASSERT_TRUE(read) << read.error().message;
  // A quarter turn about z takes x to y.
  EXPECT_NEAR((*read * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(1, 3, 3)).norm(), 0, 1e-12);
}

TEST(PoseFile, MissingKeysMeanIdentity) {
  const auto read = pose("{}");
  ASSERT_TRUE(read);
  EXPECT_TRUE(read->isApprox(Pose::Identity()));
}

TEST(PoseFile, ReadsTheStatedErrorOfACalibration) {
  const testing::TemporaryFolder folder;
  const auto read = read_pose_file(folder.write(
      "pose.json", R"({"error_p95_mm": 0.25, "from_nominal_pose": ["shift along x"]})"));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->uncertainty.error_p95_mm, 0.25);
  EXPECT_EQ(read->uncertainty.from_nominal_pose, std::vector<std::string>{"shift along x"});
}

TEST(PoseFile, InvalidPosesAreRefusedByFileAndKey) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {R"({"rotation": [1,0,0,0]})", "rotation: not a known key"},
      {R"({"rotation_wxyz": [0,0,0,0]})", "rotation_wxyz: the quaternion is too close to zero"},
      {R"({"rotation_wxyz": [1e-9,0,0,0]})", "rotation_wxyz: the quaternion is too close to zero"},
      {R"({"rotation_wxyz": [1,0,0]})", "rotation_wxyz: not a list of 4"},
      {R"({"rotation_wxyz": [1,0,0,"0"]})", "rotation_wxyz: not a list of 4"},
      {R"({"translation_mm": [1,2,3,4]})", "translation_mm: not a list of 3"},
      {R"({"translation_mm": [1,2,1e7]})", "translation_mm: a coordinate exceeds"},
      {R"({"translation_mm": [1,2,1e999]})", "pose.json: "},
      {R"({"error_p95_mm": -1})", "error_p95_mm: not an error"},
      {R"({"from_nominal_pose": [1]})", "from_nominal_pose: not a list of texts"},
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

TEST(PoseFile, QuaternionOfHugeNumbersKeepsItsDirection) {
  const auto read = pose(R"({"rotation_wxyz": [1e200, 0, 0, 1e200]})");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_NEAR((*read * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(0, 1, 0)).norm(), 0, 1e-12);
}

}  // namespace
}  // namespace hydroprint
