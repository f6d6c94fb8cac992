#include "sim/film/profile.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace hydroprint::film {
namespace {

Result<Profile> profile(const std::string& toml) {
  const testing::TemporaryFolder folder;
  return read_profile(folder.write("film.toml", toml));
}

TEST(Profile, EmptyFileIsThePapersFilm) {
  const auto read = profile("");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->thickness_mm, Profile{}.thickness_mm);
  EXPECT_EQ(read->swelling, Profile{}.swelling);
}

TEST(Profile, EveryKeyReachesItsMember) {
  const auto read = profile(
      "thickness_mm = 0.04\nink_ratio_mm = 0.01\nswelling = [1.02, 1.1]\ndrag_length_mm = 12\n"
      "tear_stretch = 2.5\nwrinkle_stretch = 0.7\nactivator_ml_per_m2 = 17\nsoak_s = 55\n"
      "activator_wait_s = 15\n");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->thickness_mm, 0.04);
  EXPECT_EQ(read->ink_ratio_mm, 0.01);
  EXPECT_EQ(read->swelling, Eigen::Vector2d(1.02, 1.1));
  EXPECT_EQ(read->drag_length_mm, 12);
  EXPECT_EQ(read->tear_stretch, 2.5);
  EXPECT_EQ(read->wrinkle_stretch, 0.7);
  EXPECT_EQ(read->activator_ml_per_m2, 17);
  EXPECT_EQ(read->soak_s, 55);
  EXPECT_EQ(read->activator_wait_s, 15);
}

TEST(Profile, WhatIsWrongIsNamedWithItsLineAndARemedy) {
  struct Case {
    std::string toml, line, remedy;
    Code code;
  };
  const std::vector<Case> cases = {
      {"soak_s = 60\nthicknes_mm = 0.5", "line 2", "thickness_mm", Code::kInvalidArgument},
      {"[film]\nsoak_s = 1", "line 1", "Use ", Code::kInvalidArgument},
      {"\n\nthickness_mm = \"0.5\"", "line 3", "number from", Code::kInvalidArgument},
      {"thickness_mm = 0", "line 1", "from 0.001 to 10", Code::kOutOfRange},
      {"thickness_mm = nan", "line 1", "from 0.001 to 10", Code::kOutOfRange},
      {"thickness_mm = inf", "line 1", "from 0.001 to 10", Code::kOutOfRange},
      {"swelling = 1.1", "line 1", "[1.0, 1.0]", Code::kInvalidArgument},
      {"swelling = [1.1]", "line 1", "[1.0, 1.0]", Code::kInvalidArgument},
      {"swelling = [1.1, 0.9]", "line 1", "from 1 to 2", Code::kOutOfRange},
      {"swelling = [2.1, 1]", "line 1", "from 1 to 2", Code::kOutOfRange},
      {"drag_length_mm = -1", "line 1", "from 0", Code::kOutOfRange},
      {"soak_s = 60\nsoak_s = 61", "line 2", "Correct", Code::kInvalidArgument},
      {"soak_s = \n", "line 1", "Correct", Code::kInvalidArgument},
  };
  for (const Case& c : cases) {
    const auto read = profile(c.toml);
    ASSERT_FALSE(read) << c.toml;
    const std::string& message = read.error().message;
    EXPECT_EQ(read.error().code, c.code) << message;
    EXPECT_NE(message.find("film.toml: " + c.line + ":"), std::string::npos) << message;
    EXPECT_NE(message.find(c.remedy), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

TEST(Profile, FilesThatCannotBeReadAreRefused) {
  EXPECT_EQ(read_profile("/no/such.toml").error().code, Code::kNotFound);
  EXPECT_EQ(read_profile("/dev/zero").error().code, Code::kInvalidArgument);
  EXPECT_EQ(read_profile("/").error().code, Code::kInvalidArgument);
}

}  // namespace
}  // namespace hydroprint::film
