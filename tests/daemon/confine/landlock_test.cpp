#include "daemon/confine/landlock.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace hydroprint::confine {
namespace {

TEST(FileFence, CoversOnlyTheSystemAndTheProgramsFolder) {
  const hydroprint::testing::TemporaryFolder folder;
  const auto program = folder.path() / "bin" / "worker";
  for (const std::filesystem::path file :
       {"/etc/hydroprint/key.pem", "/usr/key.pem", "/etc/../etc/key.pem"}) {
    EXPECT_TRUE(is_within_ruleset(file, program)) << file;
  }
  EXPECT_TRUE(is_within_ruleset(program.parent_path() / "key.pem", program));
  for (const std::filesystem::path& file :
       {folder.path() / "key.pem", std::filesystem::path("/etcetera/key.pem"),
        std::filesystem::path("/var/lib/hydroprint/tls/key.pem")}) {
    EXPECT_FALSE(is_within_ruleset(file, program)) << file;
  }
  std::filesystem::create_symlink("/etc/passwd", folder.path() / "link.pem");
  EXPECT_TRUE(is_within_ruleset(folder.path() / "link.pem", program));
}

}  // namespace
}  // namespace hydroprint::confine
