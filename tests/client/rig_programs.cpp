#include "tests/client/rig_programs.h"

#include "tests/support/paths.h"

namespace hydroprint::tests {
namespace {

using Arguments = std::vector<std::string>;

DaemonProcess::Options with(const VirtualRig& rig, DaemonProcess::Options options) {
  options.extra += rig.section();
  return options;
}

}  // namespace

RigPrograms::RigPrograms(const DaemonProcess::Options& options)
    : daemon(folder.path(), with(rig, options)) {
  EXPECT_TRUE(wait_until([&] { return state() == "DISARMED"; }));
}

std::filesystem::path RigPrograms::runtime(const std::string& user) const {
  const auto path = folder.path() / ("runtime-" + user);
  std::filesystem::create_directory(path);
  return path;
}

Arguments RigPrograms::command(const Arguments& arguments, const std::string& user) const {
  Arguments all{"/usr/bin/env", "XDG_RUNTIME_DIR=" + runtime(user).string(),
                testing::program_path("hydroprint")};
  all.insert(all.end(), {"--owner", user, "--server", daemon.address()});
  all.insert(all.end(), arguments.begin(), arguments.end());
  return all;
}

hydroprint::testing::Ended RigPrograms::client(const Arguments& arguments,
                                               const std::string& user) const {
  return hydroprint::testing::run(command(arguments, user));
}

nlohmann::json RigPrograms::client_json(Arguments arguments, const std::string& user) const {
  arguments.emplace_back("--json");
  const auto ended = client(arguments, user);
  EXPECT_EQ(ended.status, 0) << ended.err;
  auto value = nlohmann::json::parse(ended.out, nullptr, false);
  EXPECT_FALSE(value.is_discarded()) << ended.out;
  return value;
}

void RigPrograms::make_ready(double position_mm) const {
  for (const Arguments& step : {Arguments{"rig", "lease", "acquire", "--purpose", "a test"},
                                {"rig", "arm"},
                                {"rig", "home"},
                                {"rig", "move", std::to_string(position_mm), "--speed", "10"}}) {
    const auto ended = client(step);
    ASSERT_EQ(ended.status, 0) << step.at(1) << ": " << ended.err;
  }
}

}  // namespace hydroprint::tests
