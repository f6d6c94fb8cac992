// Creation of the store, and refusal of stores of other builds.
#include "daemon/store/database/schema.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <map>

#include "daemon/store/state_layout.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::daemon {
namespace {

namespace fs = std::filesystem;

class Schema : public ::testing::Test {
 protected:
  // Contents and modification times of the files in the folder, and of the folder.
  [[nodiscard]] std::map<fs::path, std::pair<std::string, fs::file_time_type>> files() const {
    std::map<fs::path, std::pair<std::string, fs::file_time_type>> out{
        {"", {"", fs::last_write_time(layout.root)}}};
    for (const auto& entry : fs::directory_iterator(layout.root)) {
      std::ifstream file(entry.path(), std::ios::binary);
      out[entry.path()] = {std::string(std::istreambuf_iterator<char>(file), {}),
                           entry.last_write_time()};
    }
    return out;
  }
  void expect_refused(const std::string& what) const {
    const auto before = files();
    const auto refused = open_store(layout.database());
    ASSERT_FALSE(refused) << what;
    EXPECT_EQ(refused.error().reason, ErrorReason::STORE_DIFFERS) << what;
    for (const std::string& part :
         {layout.database().string() + ": ", std::string("another build of hydroprint"),
          "set the state folder aside (rename " + layout.root.string() + ")"}) {
      EXPECT_NE(refused.error().message.find(part), std::string::npos) << refused.error().message;
    }
    EXPECT_EQ(files(), before) << what;
  }

  hydroprint::testing::TemporaryFolder folder;
  Layout layout{folder.path()};
};

TEST_F(Schema, AStoreIsCreatedOnceAndKeepsItsData) {
  for (const char* const expected : {"", "kept"}) {
    const auto database = open_store(layout.database());
    ASSERT_TRUE(database) << database.error().message;
    std::string value;
    EXPECT_TRUE((*database)->each("SELECT value FROM settings WHERE name='s'", {},
                                  [&](const DbRow& row) { value = row.text(0); }));
    EXPECT_EQ(value, expected);
    EXPECT_TRUE((*database)->run("INSERT OR REPLACE INTO settings VALUES ('s', 'kept')"));
  }
  EXPECT_EQ(files().size(), 2U) << "the folder and the database";
}

TEST_F(Schema, AStoreOfAnotherBuildIsRefusedAndUnchanged) {
  for (const char* const script :
       {"CREATE TABLE settings(name TEXT PRIMARY KEY, value TEXT NOT NULL);"  // a former build
        "INSERT INTO settings VALUES ('schema', '1');",
        "PRAGMA user_version=1;",  // another program
        "PRAGMA application_id=0x48795072; PRAGMA user_version=2;"}) {
    fs::remove(layout.database());
    const auto other = Database::open(layout.database(), script).value();
    ASSERT_TRUE(other->run("CREATE TABLE t(x)"));
    ASSERT_GT(fs::file_size(layout.database().string() + "-wal"), 0U);
    expect_refused(script);
  }
}

TEST_F(Schema, AFileThatIsNotADatabaseIsRefusedAndUnchanged) {
  for (const std::size_t size : {0, 50, 5000}) {
    std::ofstream(layout.database()) << std::string(size, 'x');
    expect_refused(std::to_string(size) + " bytes");
  }
}

// As after a crash during the creation, and after the loss of the database without its log.
TEST_F(Schema, RemainsOfAnotherDatabaseDoNotReachANewStore) {
  {
    const auto lost = Database::open(layout.database(), "CREATE TABLE lost(x);").value();
    ASSERT_TRUE(lost->run("INSERT INTO lost VALUES (1)"));
    fs::copy_file(layout.database().string() + "-wal", layout.root / "wal");
  }
  fs::remove(layout.database());
  fs::rename(layout.root / "wal", layout.database().string() + "-wal");
  std::ofstream(layout.database().string() + ".part") << "part";
  const auto database = open_store(layout.database());
  ASSERT_TRUE(database) << database.error().message;
  EXPECT_FALSE((*database)->run("SELECT * FROM lost"));
  EXPECT_TRUE((*database)->run("SELECT * FROM jobs"));
  EXPECT_FALSE(fs::exists(layout.database().string() + ".part"));
}

}  // namespace
}  // namespace hydroprint::daemon
