// hydroprint-virtual-rig as its users run it.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/hardware/simulator/drive/bench_rig.h"
#include "tests/support/paths.h"

namespace hydroprint::simulated_drive {
namespace {

const std::string kProgram = testing::program_path("hydroprint-virtual-rig");
const std::string kProfile = testing::drive_profile_path("virtual");

TEST(Program, PrintsItsAddressesAcceptsActionsAndExitsCleanly) {
  testing::VirtualRig rig({.wire = "rtu", .arguments = {"--tcp", "0"}});
  const auto line = rig.folder() / "drive";
  const std::string reply = rig.act("press stop\nstate\ndance");
  EXPECT_EQ(reply.substr(0, 3), "ok\n");
  const auto state = nlohmann::json::parse(reply.substr(3, reply.find('\n', 3) - 3));
  EXPECT_TRUE(state.at("stop_button").get<bool>());
  EXPECT_NE(reply.find("error: \"dance\" is not a known action"), std::string::npos);

  const auto profile = drive::read_drive_profile(kProfile);
  drive::Drive drive(*profile,
                     std::make_shared<drive::Link>(*drive::parse_endpoint("rtu:" + line.string()),
                                                   drive::LinkTiming{}));
  HP_ASSERT_OK(drive.connect());
  EXPECT_TRUE(drive.poll()->stop_input);

  const auto ended = rig.stop();
  EXPECT_EQ(ended.status, 0) << ended.err;
  const auto where = nlohmann::json::parse(ended.out);
  EXPECT_EQ(where.at("tcp").get<std::string>().substr(0, 14), "tcp:127.0.0.1:");
  EXPECT_EQ(where.at("rtu"), "rtu:" + line.string() + "?baud=115200&parity=E&stop=1");
  EXPECT_FALSE(std::filesystem::exists(rig.control()));
  EXPECT_FALSE(std::filesystem::is_symlink(line));
}

TEST(Program, FaultsOfTheCommandLineTakeEffect) {
  const testing::VirtualRig rig({.arguments = {"--fault", "press=stop,stall@100ms"}});
  EXPECT_TRUE(testing::wait_until([&] { return rig.truth().at("stalled").get<bool>(); }));
  EXPECT_TRUE(rig.truth().at("stop_button").get<bool>());
}

TEST(Program, ErrorsAreOneLineWithTheContractsExitStatus) {
  const testing::TemporaryFolder folder;
  const auto bad = folder.write("bad.toml", "name = 3\n").string();
  const auto torn = folder.write("torn.toml", "\"a\\nb\" = 3\n").string();
  const auto scene = folder.write("scene.toml", "[water]\nat = 3\n").string();
  const std::vector<std::pair<std::vector<std::string>, int>> cases = {
      {{}, 2},
      {{"--profile", kProfile, "--tcp", "70000"}, 2},
      {{"--profile", "none.toml"}, 3},
      {{"--profile", bad}, 3},
      {{"--profile", torn}, 3},
      {{"--profile", "no\nne.toml"}, 3},
      {{"--profile", kProfile, "--scene", scene}, 3},
      {{"--profile", kProfile, "--fault", "dance@3s"}, 3},
      {{"--profile", kProfile, "--tcp", "0", "--control", "/nowhere/at/all"}, 3},
      {{"--profile", kProfile, "--rtu", bad}, 3}};
  for (const auto& [arguments, status] : cases) {
    std::vector<std::string> all = {kProgram};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const auto ended = testing::run(all);
    EXPECT_EQ(ended.status, status) << ended.err;
    EXPECT_FALSE(ended.err.empty());
    if (status == 3) {
      EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1);
    }
  }
  EXPECT_EQ(testing::run({kProgram, "--help"}).status, 0);
}

}  // namespace
}  // namespace hydroprint::simulated_drive
