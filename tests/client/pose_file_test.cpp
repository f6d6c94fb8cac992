#include "client/pose_file.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/temporary_folder.h"

namespace hydroprint::client {
namespace {

std::vector<double> numbers(const auto& values) { return {values.begin(), values.end()}; }

class PoseFile : public ::testing::Test {
 protected:
  Result<v1::Pose> read(std::string_view content) {
    return read_pose_file(folder_.write("pose.json", content));
  }
  testing::TemporaryFolder folder_;
};

TEST_F(PoseFile, ReadsRotationAndTranslation) {
  const auto pose = read(R"({"rotation_wxyz":[0.6,0.8,0,0],"translation_mm":[1,2,3.5]})");
  ASSERT_TRUE(pose) << pose.error().message;
  EXPECT_EQ(numbers(pose->rotation_wxyz()), (std::vector<double>{0.6, 0.8, 0, 0}));
  EXPECT_EQ(numbers(pose->translation_mm()), (std::vector<double>{1, 2, 3.5}));
}

TEST_F(PoseFile, NormalizesTheRotationLikeTheWorker) {
  const auto pose = read(R"({"rotation_wxyz":[2,0,0,0]})");
  ASSERT_TRUE(pose) << pose.error().message;
  EXPECT_EQ(numbers(pose->rotation_wxyz()), (std::vector<double>{1, 0, 0, 0}));
}

TEST_F(PoseFile, RefusesInvalidPosesWithOneLineThatNamesTheFile) {
  for (const char* content :
       {"", "[]", "{\"rotation_wxyz\":", R"({"rotation":[1,0,0,0]})", R"({"rotation_wxyz":[1,0]})",
        R"({"translation_mm":[1,2,"x"]})", R"({"translation_mm":[1,2,1e999]})"}) {
    const auto pose = read(content);
    ASSERT_FALSE(pose) << content;
    EXPECT_EQ(pose.error().code, Code::kInvalidArgument);
    EXPECT_NE(pose.error().message.find("pose.json"), std::string::npos);
    EXPECT_EQ(pose.error().message.find('\n'), std::string::npos);
  }
}

}  // namespace
}  // namespace hydroprint::client
