#include "sim/base/csv_file.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace hydroprint {
namespace {

Result<CsvTable> table(const std::string& csv, std::size_t most_rows = 100) {
  const testing::TemporaryFolder folder;
  return read_csv(folder.write("table.csv", csv), "a_mm,b", most_rows);
}

TEST(CsvFile, BlanksAndEmptyLinesAtTheEndAreIgnored) {
  const auto read = table(" a_mm , b\r\n1, -2.5e3\r\n 0.25 ,4\r\n\r\n  \n");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->values, (std::vector<double>{1, -2500, 0.25, 4}));
  ASSERT_EQ(read->rows(), 2u);
  EXPECT_EQ(read->row(1)[0], 0.25);
  EXPECT_TRUE(read->place(1).ends_with("table.csv: line 3"));
  const auto none = table("a_mm,b");
  ASSERT_TRUE(none) << none.error().message;
  EXPECT_EQ(none->rows(), 0u);
}

TEST(CsvFile, MalformedTablesAreRefusedByLineWithARemedy) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "line 1: wrong header: column a_mm is missing. Write a_mm,b"},
      {"1,2\n", "line 1: wrong header: column a_mm is missing. Write a_mm,b"},
      {"a_mm\n1\n", "line 1: wrong header: column b is missing. Write a_mm,b"},
      {"b,a_mm\n1,2\n", "line 1: wrong header. Write a_mm,b"},
      {"a_mm,b,c\n1,2,3\n", "line 1: wrong header. Write a_mm,b"},
      {"a_mm,b\n1,2\n3\n",
       "line 3: expected 2 finite numbers, but the number of cells is 1. Write a_mm,b"},
      {"a_mm,b\n1,2,3\n",
       "line 2: expected 2 finite numbers, but the number of cells is 3. Write a_mm,b"},
      {"a_mm,b\n1,\n", "line 2: expected 2 finite numbers, but b is ''. Write a_mm,b"},
      {"a_mm,b\n1,nan\n", "line 2: expected 2 finite numbers, but b is 'nan'. Write a_mm,b"},
      {"a_mm,b\n-inf,1\n", "line 2: expected 2 finite numbers, but a_mm is '-inf'. Write a_mm,b"},
      {"a_mm,b\n1,1e999\n", "line 2: expected 2 finite numbers, but b is '1e999'. Write a_mm,b"},
      {"a_mm,b\n1,two\n", "line 2: expected 2 finite numbers, but b is 'two'. Write a_mm,b"},
      {"a_mm,b\n1,2x\n", "line 2: expected 2 finite numbers, but b is '2x'. Write a_mm,b"},
      {"a_mm,b\n\n1,2\n",
       "line 2: expected 2 finite numbers, but the number of cells is 0. Write a_mm,b"},
  };
  for (const auto& [csv, text] : cases) {
    const auto read = table(csv);
    ASSERT_FALSE(read) << csv;
    EXPECT_NE(read.error().message.find("table.csv: " + text), std::string::npos)
        << read.error().message;
    EXPECT_EQ(exit_status(read.error()), ExitStatus::kBadInput);
  }
}

TEST(CsvFile, TooManyRowsAreRefusedBeforeTheyAreStored) {
  EXPECT_TRUE(table("a_mm,b\n1,2\n3,4\n", 2));
  const auto read = table("a_mm,b\n1,2\n3,4\n5,6\n", 2);
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find("line 4: too many rows. Use at most 2"), std::string::npos);
}

}  // namespace
}  // namespace hydroprint
