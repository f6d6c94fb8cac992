// Small files, impossible values and paths, and a full disk.

#include <gtest/gtest.h>
#include <sys/mount.h>

#include <algorithm>
#include <iterator>

#include "tests/sim/worker/worker_fixture.h"

namespace hydroprint::worker {
namespace {

namespace fs = std::filesystem;

TEST_F(Worker, APoseWhoseFirstContactMissesTheFilmIsRefused) {
  folder.write("pose.json", R"({"translation_mm": [31, 0, 0]})");
  expect_refusal(3, simulate({"--pose", path("pose.json")}), {"film"});
}

TEST_F(Worker, ValuesOutOfRangeAreBadInput) {
  for (const Arguments& flags : {Arguments{"--dpi", "0"},
                                 {"--dpi", "-300"},
                                 {"--dpi", "1e9"},
                                 {"--dpi", "nan"},
                                 {"--film", "5x5"},
                                 {"--film", "3000x200"},
                                 {"--film", "circle:0"},
                                 {"--scale", "0"},
                                 {"--scale", "-1"},
                                 {"--scale", "inf"},
                                 {"--depth-mm", "0"},
                                 {"--depth-mm", "-3"},
                                 {"--dip-speed-mm-per-s", "0"}}) {
    SCOPED_TRACE(flags[1]);
    expect_refusal(3, simulate(flags), {flags[0] + ": "});
  }
  // Each value is in range, but the combination is not.
  expect_refusal(3, simulate({"--film", "2000x2000", "--dpi", "2400"}), {"dpi"});
}

TEST_F(Worker, BadSmallFilesAreRefusedByNameAndPlace) {
  folder.write("pose.json", R"({"rotation_wxyz": [0, 0, 0, 0]})");
  expect_refusal(3, simulate({"--pose", path("pose.json")}), {"pose.json: rotation_wxyz: "});
  folder.write("film.toml", "\nthick_mm = 1\n");
  expect_refusal(3, simulate({"--profile", path("film.toml")}), {"film.toml: line 2: thick_mm"});
  folder.write("film.json", "[[0,0],[40,40],[40,0],[0,40]]");
  expect_refusal(3, simulate({"--film", std::string("polygon:") + path("film.json")}),
                 {"film.json: "});
  expect_refusal(3, simulate({"--film", std::string("polygon:") + path("no.json")}),
                 {"no.json: no such file"});
}

TEST_F(Worker, AFileBeyondTheLimitIsReportedAndNothingStays) {
  ProcessOptions limited;
  limited.limits = {{RLIMIT_FSIZE, 20000}};
  expect_refusal(3, simulate({"--texture", path("texture.png")}),
                 {"out", "larger than the limit on file sizes"}, limited);
}

TEST_F(Worker, AFullFileSystemIsReportedAndNothingStays) {
  const fs::path disk = folder.path() / "disk";
  fs::create_directory(disk);
  if (::mount("none", disk.c_str(), "tmpfs", 0, "size=16k") != 0)
    GTEST_SKIP() << "needs root, to mount a small disk";
  Arguments command = simulate({"--texture", path("texture.png")});
  *std::next(std::find(command.begin(), command.end(), "--out")) = disk / "out";
  expect_refusal(3, command, {"disk/out", "disk is full"});
  EXPECT_TRUE(names_in(disk).empty());
  ::umount2(disk.c_str(), MNT_DETACH);
}

TEST_F(Worker, AnOutFolderThatCannotBeCreatedIsRefusedFirst) {
  Arguments command = simulate();
  *std::next(std::find(command.begin(), command.end(), "--out")) = path("no/out");
  expect_refusal(3, command, {"no: no such folder", "another folder"});
  *std::next(std::find(command.begin(), command.end(), "--out")) = path("sphere.obj");
  expect_refusal(3, command, {"sphere.obj: is a file"});
}

TEST_F(Worker, NamesWithLineEndsStayOnOneLine) {
  expect_refusal(3, simulate({"--mesh", path("two\nlines.obj")}, false), {"two lines.obj"});
}

}  // namespace
}  // namespace hydroprint::worker
