#include "sim/film/profile.h"

#include <gtest/gtest.h>

#include <sstream>

#include "sim/base/input_file.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::film {
namespace {

Result<Profile> profile(const std::string& toml) {
  const testing::TemporaryFolder folder;
  return read_profile(folder.write("film.toml", toml));
}

void expect_equal(const Profile& a, const Profile& b) {
  EXPECT_EQ(a.thickness_mm, b.thickness_mm);
  EXPECT_EQ(a.ink_ratio_mm, b.ink_ratio_mm);
  EXPECT_EQ(a.ink_icc_profile, b.ink_icc_profile);
  EXPECT_EQ(a.swelling, b.swelling);
  EXPECT_EQ(a.drag_length_mm, b.drag_length_mm);
  EXPECT_EQ(a.tear_stretch, b.tear_stretch);
  EXPECT_EQ(a.wrinkle_stretch, b.wrinkle_stretch);
  EXPECT_EQ(a.young_modulus_mpa, b.young_modulus_mpa);
  EXPECT_EQ(a.density_kg_per_m3, b.density_kg_per_m3);
  EXPECT_EQ(a.poisson_ratio, b.poisson_ratio);
  EXPECT_EQ(a.activator_ml_per_m2, b.activator_ml_per_m2);
  EXPECT_EQ(a.soak_s, b.soak_s);
  EXPECT_EQ(a.activator_wait_s, b.activator_wait_s);
}

/// The keys listed in the error for an unknown key.
std::vector<std::string> known_keys() {
  const std::string message = profile("no_such_key = 1").error().message;
  std::istringstream list(message.substr(message.find("Use ") + 4));
  std::vector<std::string> keys;
  for (std::string key; std::getline(list >> std::ws, key, ',');) keys.push_back(key);
  return keys;
}

TEST(Profile, EmptyFileIsThePapersFilm) {
  const auto read = profile("");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->thickness_mm, 0.5);
  EXPECT_EQ(read->ink_ratio_mm, 0.05);
  EXPECT_EQ(read->young_modulus_mpa, 1.82);
  EXPECT_EQ(read->density_kg_per_m3, 1300);
  EXPECT_EQ(read->poisson_ratio, 0.5);
  expect_equal(*read, Profile{});
}

TEST(Profile, EveryKeyReachesItsMember) {
  const auto read = profile(
      "thickness_mm = 0.04\nink_ratio_mm = 0.01\nswelling = [1.02, 1.1]\ndrag_length_mm = 12\n"
      "tear_stretch = 2.5\nwrinkle_stretch = 0.7\nactivator_ml_per_m2 = 17\nsoak_s = 55\n"
      "activator_wait_s = 15\nyoung_modulus_mpa = 2\ndensity_kg_per_m3 = 1200\n"
      "poisson_ratio = 0.45\nink_icc_profile = \"/icc/printer.icc\"\n");
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
  EXPECT_EQ(read->young_modulus_mpa, 2);
  EXPECT_EQ(read->density_kg_per_m3, 1200);
  EXPECT_EQ(read->poisson_ratio, 0.45);
  EXPECT_EQ(read->ink_icc_profile, "/icc/printer.icc");
}

TEST(Profile, RelativeIccProfilesStartAtTheFilesFolder) {
  const testing::TemporaryFolder folder;
  const auto file = folder.write("film.toml", "ink_icc_profile = \"icc/printer.icc\"");
  const auto read = read_profile(file);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->ink_icc_profile, folder.path() / "icc/printer.icc");
  const auto none = profile("ink_icc_profile = \"\"");
  ASSERT_TRUE(none) << none.error().message;
  EXPECT_TRUE(none->ink_icc_profile.empty())
      << "an empty path must not become the folder of the file";
}

TEST(Profile, ExampleShowsEveryKeyWithItsDefault) {
  const auto read = read_profile(testing::source_path("deploy/film_profile.toml.example"));
  ASSERT_TRUE(read) << read.error().message;
  expect_equal(*read, Profile{});
  const auto text =
      read_text_file(testing::source_path("deploy/film_profile.toml.example"), 1 << 20);
  ASSERT_TRUE(text);
  const auto keys = known_keys();
  EXPECT_EQ(keys.size(), 13u);
  for (const std::string& key : keys) {
    EXPECT_NE(text->find("\n" + key + " = "), std::string::npos) << key;
  }
}

TEST(Profile, InkAddsProportionallyToTheThickness) {
  Profile film;
  EXPECT_DOUBLE_EQ(rest_thickness_mm(film, 0), 0.5);
  EXPECT_DOUBLE_EQ(rest_thickness_mm(film, 4), 0.7);
  film.thickness_mm = 0.04;
  film.ink_ratio_mm = 0.002;
  EXPECT_DOUBLE_EQ(rest_thickness_mm(film, 1.5), 0.043);
}

TEST(Profile, ErrorsNameTheirLineAndARemedy) {
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
      {"young_modulus_mpa = 0", "line 1", "from 1e-06", Code::kOutOfRange},
      {"density_kg_per_m3 = 0", "line 1", "from 1 to", Code::kOutOfRange},
      {"poisson_ratio = 0.51", "line 1", "from 0 to 0.5", Code::kOutOfRange},
      {"poisson_ratio = -0.1", "line 1", "from 0 to 0.5", Code::kOutOfRange},
      {"ink_icc_profile = 1", "line 1", "printer.icc", Code::kInvalidArgument},
      {"ink_icc_profile = [\"a.icc\"]", "line 1", "printer.icc", Code::kInvalidArgument},
      {"ink_icc_profile = \"a\\u0000.icc\"", "line 1", "printer.icc", Code::kInvalidArgument},
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

TEST(Profile, WrittenProfilesReadBackUnchanged) {
  Profile odd;
  odd.thickness_mm = 0.1 + 0.2;
  odd.ink_ratio_mm = 1.0 / 3;
  odd.ink_icc_profile = "/icc/a \"quoted\" \\ printer.icc";
  odd.swelling = {1 + 1e-15, 1.0 / 0.9};
  odd.drag_length_mm = 1e-5;
  odd.tear_stretch = 2.5;
  odd.wrinkle_stretch = 0.7;
  odd.young_modulus_mpa = 1e-6;
  odd.density_kg_per_m3 = 1234.5;
  odd.poisson_ratio = 0.45;
  odd.activator_ml_per_m2 = 17;
  odd.soak_s = 55;
  odd.activator_wait_s = 15;
  for (const Profile& written : {odd, Profile{}}) {
    const auto read = profile(profile_toml(written));
    ASSERT_TRUE(read) << read.error().message;
    expect_equal(*read, written);
  }
}

}  // namespace
}  // namespace hydroprint::film
