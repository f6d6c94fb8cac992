#include "sim/worker/common/motion_file.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace hydroprint::worker {
namespace {

Result<waterline::Motion> motion(const std::string& csv) {
  const testing::TemporaryFolder folder;
  return read_motion(folder.write("motion.csv", csv));
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

TEST(MotionFile, InvalidMotionsAreRefusedByLine) {
  const std::string header = "t_s,x_mm,y_mm,z_mm\n";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "line 1: wrong header"},
      {"0,0,0,0\n1,0,0,-1\n", "line 1: wrong header"},
      {"t,x,y,z\n0,0,0,0\n1,0,0,-1\n", "line 1: wrong header"},
      {header, "fewer than two rows"},
      {header + "0,0,0,0\n", "fewer than two rows"},
      {header + "0,0,0,0\n1,0,0\n", "line 3: expected 4 finite numbers"},
      {header + "0,0,0,0\n1,0,0,-1,0\n", "line 3: expected 4 finite numbers"},
      {header + "0,0,0,0\n1,0,nan,-1\n", "line 3: expected 4 finite numbers"},
      {header + "0,0,0,0\n1,0,inf,-1\n", "line 3: expected 4 finite numbers"},
      {header + "0,0,0,0\n1,0,1e999,-1\n", "line 3: expected 4 finite numbers"},
      {header + "0,0,0,0\n\n1,0,0,-1\n", "line 3: expected 4 finite numbers"},
      {header + "0,0,0,0\n1,0,0,-1\n1,0,0,-2\n", "line 4: t_s does not increase"},
      {header + "0,0,0,0\n1,0,0,-1\n2,0,0,-0.5\n", "line 4: z_mm rises"},
      {header + "0,0,0,0\n1,0,2e4,-1\n", "line 3: more than 10 m from the start"},
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

}  // namespace
}  // namespace hydroprint::worker
