#include "sim/fit/points.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace hydroprint::fit {
namespace {

const std::string kHeader = "film_x_mm,film_y_mm,X_mm,Y_mm,Z_mm\n";

Result<std::vector<Point>> points(const std::string& csv) {
  const testing::TemporaryFolder folder;
  return read_points(folder.write("measured.csv", csv));
}

TEST(Points, FilmColumnsPrecedeSurfaceColumns) {
  const auto read = points(kHeader + "1,2,3,4,5\n-1.5,0,0,1e2,-7\n");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->size(), 2u);
  EXPECT_EQ((*read)[0].film_mm, Eigen::Vector2d(1, 2));
  EXPECT_EQ((*read)[0].surface_mm, Eigen::Vector3d(3, 4, 5));
  EXPECT_EQ((*read)[1].surface_mm, Eigen::Vector3d(0, 100, -7));
}

TEST(Points, BadFilesAreRefusedByLineWithARemedy) {
  const std::string write = "Write film_x_mm,film_y_mm,X_mm,Y_mm,Z_mm";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "line 1: wrong header"},
      {"film_x_mm,film_y_mm,X_mm,Y_mm\n1,2,3,4\n",
       "line 1: wrong header: column Z_mm is missing. " + write},
      {kHeader, "line 2: no points. Write one"},
      {kHeader + "1,2,3,4\n",
       "line 2: expected 5 finite numbers, but the number of cells is 4. " + write},
      {kHeader + "1,2,3,4,5\n1,2,nan,4,5\n",
       "line 3: expected 5 finite numbers, but X_mm is 'nan'. " + write},
      {kHeader + "1,2,3,four,5\n",
       "line 2: expected 5 finite numbers, but Y_mm is 'four'. " + write},
      {kHeader + "1,2,3,4,20000\n",
       "line 2: a coordinate exceeds 1e4 mm. Check that the coordinates are in mm"},
  };
  for (const auto& [csv, text] : cases) {
    const auto read = points(csv);
    ASSERT_FALSE(read) << csv;
    EXPECT_NE(read.error().message.find("measured.csv: " + text), std::string::npos)
        << read.error().message;
    EXPECT_EQ(exit_status(read.error()), ExitStatus::kBadInput);
  }
}

TEST(Points, TwentyThousandAreReadAndOneMoreIsRefused) {
  std::string csv = kHeader;
  for (std::size_t i = 0; i < kMostPoints; ++i) csv += "1,2,3,4,5\n";
  EXPECT_TRUE(points(csv));
  const auto read = points(csv + "1,2,3,4,5\n");
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find("line 20002: too many rows. Use at most 20000"),
            std::string::npos)
      << read.error().message;
}

}  // namespace
}  // namespace hydroprint::fit
