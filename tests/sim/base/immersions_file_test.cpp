#include "sim/base/immersions_file.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace hydroprint {
namespace {

Result<std::vector<ListedDip>> read(const std::string& json) {
  const testing::TemporaryFolder folder;
  return read_immersions_file(folder.write("three.json", json));
}

std::string dip(const std::string& more) {
  return R"({"rotation_wxyz": [1, 0, 0, 0], "translation_mm": [1, 2, 3])" + more + "}";
}

TEST(ImmersionsFile, ListsPosesAndDepths) {
  const auto dips =
      read("[" + dip(R"(, "depth_mm": "full")") + ", " + dip(R"(, "depth_mm": 12.5)") + ", " +
           dip(R"(, "error_p95_mm": 0.25)") + "]");
  ASSERT_TRUE(dips) << dips.error().message;
  ASSERT_EQ(dips->size(), 3U);
  EXPECT_EQ((*dips)[0].depth_mm, std::nullopt);
  EXPECT_EQ((*dips)[0].pose.translation_mm, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ((*dips)[1].depth_mm, 12.5);
  EXPECT_EQ((*dips)[2].depth_mm, std::nullopt);
  EXPECT_EQ((*dips)[2].pose.uncertainty.error_p95_mm, 0.25);
}

TEST(ImmersionsFile, TakesTwelveDipsAndNoMore) {
  std::string list = dip("");
  for (int i = 2; i <= kMostDips; ++i) list += ", " + dip("");
  const auto dips = read("[" + list + "]");
  ASSERT_TRUE(dips) << dips.error().message;
  EXPECT_EQ(dips->size(), 12U);
  const auto thirteen = read("[" + list + ", " + dip("") + "]");
  ASSERT_FALSE(thirteen);
  EXPECT_NE(thirteen.error().message.find("three.json: 13 dips. List at most 12"),
            std::string::npos)
      << thirteen.error().message;
}

TEST(ImmersionsFile, InvalidListsAreRefusedByFileDipAndKey) {
  const std::string good = dip("") + ", ";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"[]", "three.json: no dips. List at least one"},
      {dip(""), "three.json: not a list of dips"},
      {"[" + good + "7]", "three.json: dip 2: not a dip"},
      {"[" + good + R"({"translation_mm": [0, 0, 0]}])", "dip 2: rotation_wxyz is missing"},
      {"[" + good + R"({"rotation_wxyz": [1, 0, 0, 0]}])", "dip 2: translation_mm is missing"},
      {"[" + good + R"({"rotation_wxyz": [1, 1, 0, 0], "translation_mm": [0, 0, 0]}])",
       "dip 2: rotation_wxyz: the quaternion has length 1.414 instead of 1"},
      {"[" + good + R"({"rotation_wxyz": [0, 0, 0, 0], "translation_mm": [0, 0, 0]}])",
       "dip 2: rotation_wxyz: the quaternion is too close to zero"},
      {"[" + good + R"({"rotation_wxyz": [1, 0, 0], "translation_mm": [0, 0, 0]}])",
       "dip 2: rotation_wxyz: not a list of 4 numbers"},
      {"[" + dip(R"(, "depth_mm": -3)") + "]", "dip 1: depth_mm: -3 is not a depth"},
      {"[" + dip(R"(, "depth_mm": 0)") + "]", "dip 1: depth_mm: 0 is not a depth"},
      {"[" + dip(R"(, "depth_mm": "deep")") + "]", "dip 1: depth_mm: \"deep\" is not a depth"},
      {"[" + dip(R"(, "depth_mm": null)") + "]", "dip 1: depth_mm: null is not a depth"},
      {"[" + dip(R"(, "depth": 3)") + "]", "dip 1: depth: not a known key"},
      {"[" + dip("") + "\n,]", "line 2"},
  };
  for (const auto& [json, text] : cases) {
    const auto dips = read(json);
    ASSERT_FALSE(dips) << json;
    EXPECT_NE(dips.error().message.find(text), std::string::npos) << dips.error().message;
    EXPECT_NE(dips.error().message.find("three.json: "), std::string::npos);
    EXPECT_EQ(exit_status(dips.error()), ExitStatus::kBadInput);
  }
}

}  // namespace
}  // namespace hydroprint
