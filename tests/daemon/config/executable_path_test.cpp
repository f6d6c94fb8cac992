#include "daemon/config/executable_path.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "tests/support/temporary_folder.h"

namespace hydroprint::daemon {
namespace {

namespace fs = std::filesystem;

class OwnProgram : public ::testing::Test {
 protected:
  OwnProgram() {
    fs::create_directories(bin);
    fs::create_directories(other);
    std::ofstream(program) << "#!/bin/true\n";
    ::chmod(program.c_str(), 0755);
  }

  hydroprint::testing::TemporaryFolder folder;
  const fs::path root = fs::canonical(folder.path());
  const fs::path bin = root / "bin", other = root / "other", program = bin / "hydroprintd";
  const fs::path no_proc = root / "proc/self/exe";
};

TEST_F(OwnProgram, FollowsTheLinkInProc) {
  fs::create_symlink(program, root / "exe");
  EXPECT_EQ(own_program("nonsense", "", root / "exe"), program);
}

TEST_F(OwnProgram, IsTheCalledPathWithoutProc) {
  EXPECT_EQ(own_program(program.string(), "", no_proc), program);
  EXPECT_EQ(own_program(fs::relative(program).string(), "", no_proc), program);
}

TEST_F(OwnProgram, ResolvesACalledLink) {
  fs::create_symlink(program, other / "hydroprintd");
  EXPECT_EQ(own_program((other / "hydroprintd").string(), "", no_proc), program);
}

TEST_F(OwnProgram, IsTheFirstMatchInThePath) {
  fs::create_directory(other / "hydroprintd");  // a folder with the program's name
  const std::string path = root.string() + "/none:" + other.string() + ":" + bin.string();
  EXPECT_EQ(own_program("hydroprintd", path, no_proc), program);
}

TEST_F(OwnProgram, IsUnknownWithoutAMatch) {
  EXPECT_EQ(own_program("hydroprintd", other.string(), no_proc), "");
  EXPECT_EQ(own_program((other / "hydroprintd").string(), bin.string(), no_proc), "");
}

}  // namespace
}  // namespace hydroprint::daemon
