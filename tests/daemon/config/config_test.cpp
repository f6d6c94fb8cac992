#include "daemon/config/config.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "daemon/config/bind_policy.h"
#include "daemon/config/rig_config_check.h"
#include "daemon/config/slurm_config.h"
#include "tests/support/paths.h"

namespace hydroprint::daemon {
namespace {

std::string problem(const std::string& text) {
  const auto config = parse_config(text, "d.toml");
  return config ? "accepted" : config.error().message;
}

bool says(const std::string& message, const std::string& part) {
  return message.find(part) != std::string::npos;
}

TEST(Config, ExampleNamesEveryKeyWithItsDefault) {
  std::ifstream file(testing::source_path("deploy/hydroprintd.toml.example"));
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const auto config = parse_config(text, "example");
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(*config, Config{});
  std::string section;
  std::vector<std::string> named;
  std::ifstream lines(testing::source_path("deploy/hydroprintd.toml.example"));
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("[")) section = line.substr(1, line.find(']') - 1);
    if (line.find(" = ") != std::string::npos && !line.starts_with("#")) {
      named.push_back(section + "." + line.substr(0, line.find(' ')));
    }
  }
  EXPECT_EQ(named, config_keys());
}

TEST(Config, AbsentKeysKeepTheirDefaults) {
  const auto config = parse_config("[workers]\ncount = 3\n", "d.toml");
  ASSERT_TRUE(config);
  EXPECT_EQ(config->workers_count, 3);
  EXPECT_EQ(config->workers_time_limit_s, Config{}.workers_time_limit_s);
}

TEST(Config, UnknownKeyIsReportedWithPlaceAndSuggestion) {
  const std::string message = problem("[workers]\ncount = 1\ntime_limit = 60\n");
  EXPECT_TRUE(says(message, "d.toml:3:")) << message;
  EXPECT_TRUE(says(message, "workers.time_limit")) << message;
  EXPECT_TRUE(says(message, "did you mean \"workers.time_limit_s\"")) << message;
}

TEST(Config, UnknownSectionListsAllSections) {
  const std::string message = problem("\n[worker]\ncount = 1\n");
  EXPECT_TRUE(says(message, "d.toml:2:")) << message;
  EXPECT_TRUE(says(message, "[workers]")) << message;
}

TEST(Config, WrongTypesAndRangesNameTheValidOnes) {
  EXPECT_TRUE(says(problem("[workers]\nmemory_mib = \"4 GiB\"\n"), "whole number of MiB"));
  EXPECT_TRUE(says(problem("[workers]\ntime_limit_s = 1.5\n"), "whole number of seconds"));
  EXPECT_TRUE(says(problem("[workers]\ncount = -1\n"), "from 0 to 256"));
  EXPECT_TRUE(says(problem("[workers]\ncount = 257\n"), "d.toml:2:"));
  EXPECT_TRUE(says(problem("[server]\nreflection = 1\n"), "true or false"));
  EXPECT_TRUE(says(problem("[log]\nlevel = \"loud\"\n"), "\"warning\""));
  EXPECT_TRUE(says(problem("[log]\nlevel = 3\n"), "one of"));
}

TEST(Config, SectionInASectionIsRead) {
  const auto config = parse_config(
      "[workers]\nexecutor = \"slurm\"\ncount = 3\n[workers.slurm]\nfolder = \"/shared/h\"\n"
      "installation = \"lab2\"\noptions = \"--qos=low  --constraint=avx2\"\njobs = 40\n",
      "d.toml");
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->workers_executor, "slurm");
  EXPECT_EQ(config->workers_count, 3);
  EXPECT_EQ(config->slurm_folder, "/shared/h");
  EXPECT_EQ(config->slurm_installation, "lab2");
  EXPECT_EQ(config->slurm_jobs, 40);
  EXPECT_EQ(slurm_options(*config), (std::vector<std::string>{"--qos=low", "--constraint=avx2"}));
}

TEST(Config, SlurmNeedsWhatItCannotGuess) {
  const auto with = [](const std::string& lines) {
    return problem("[workers]\nexecutor = \"slurm\"\n[workers.slurm]\n" + lines);
  };
  const std::string folder = "folder = \"/shared\"\n";
  EXPECT_EQ(with(folder), "accepted");
  EXPECT_TRUE(says(with(""), "workers.slurm.folder")) << with("");
  EXPECT_TRUE(says(with("folder = \"shared\"\n"), "absolute"));
  for (const char* name : {"", "Lab", "a-b", "a/b", "a b", "../x"}) {
    const std::string message = with(folder + "installation = \"" + name + "\"\n");
    EXPECT_TRUE(says(message, "workers.slurm.installation")) << message;
  }
  EXPECT_TRUE(says(with(folder + "partition = \"a b\"\n"), "workers.slurm.partition"));
  EXPECT_TRUE(says(with(folder + "account = \"$(x)\"\n"), "workers.slurm.account"));
  EXPECT_TRUE(says(with(folder + "options = \"qos\"\n"), "not an option of sbatch"));
  EXPECT_TRUE(says(with(folder + "options = \"--qos=a;b\"\n"), "not an option of sbatch"));
  EXPECT_TRUE(says(with(folder + "options = \"--requeue\"\n"), "the daemon sets --requeue"));
  EXPECT_TRUE(says(with(folder + "jobs = 0\n"), "from 1 to 10000"));
  EXPECT_TRUE(says(with(folder + "fodler = 0\n"), "workers.slurm.fodler"));
  EXPECT_TRUE(says(problem("[workers]\nexecutor = \"condor\"\n"), "\"slurm\""));
}

TEST(Config, InvalidTomlIsReportedWithItsLine) {
  EXPECT_TRUE(says(problem("[log]\nlevel = = 3\n"), "d.toml:2: not valid TOML"));
  EXPECT_TRUE(says(problem("count = 1\n"), "unknown section \"count\""));
}

TEST(Config, MissingFileIsNamed) {
  const auto config = read_config("/nonexistent/x.toml");
  ASSERT_FALSE(config);
  EXPECT_EQ(config.error().code, Code::kNotFound);
  EXPECT_TRUE(says(config.error().message, "/nonexistent/x.toml"));
}

TEST(Config, EndpointsAreAddressesAndKnowLoopback) {
  EXPECT_EQ(parse_endpoint("127.0.0.1:50051")->text(), "127.0.0.1:50051");
  EXPECT_EQ(parse_endpoint("127.1.2.3:0")->port, 0);
  EXPECT_EQ(parse_endpoint("[::1]:80")->text(), "[::1]:80");
  EXPECT_EQ(parse_endpoint("localhost:7")->host, "127.0.0.1");
  for (const char* here : {"127.0.0.1:1", "127.1.2.3:1", "[::1]:1", "localhost:1"}) {
    EXPECT_TRUE(parse_endpoint(here)->is_loopback()) << here;
  }
  for (const char* beyond : {"0.0.0.0:1", "[::]:1", "192.168.0.2:1", "128.0.0.1:1"}) {
    EXPECT_FALSE(parse_endpoint(beyond)->is_loopback()) << beyond;
  }
  for (const char* bad :
       {"example.org:1", ":1", "0.0.0:1", "127.0.0.1", "127.0.0.1:", "127.0.0.1:65536",
        "127.0.0.1:-1", "127.0.0.1:1x", "127.0.0.1.evil.org:1", "unix:/tmp/x", ""}) {
    EXPECT_FALSE(parse_endpoint(bad)) << bad;
  }
  EXPECT_TRUE(says(problem("[server]\ngrpc = \"example.org:1\"\n"), "d.toml:2: server.grpc"));
  EXPECT_TRUE(says(problem("[server]\nhttp = \"example.org:1\"\n"), "d.toml:2: server.http"));
}

TEST(Config, AddressesBeyondLoopbackRequireTls) {
  Config config;
  EXPECT_TRUE(check_exposure(config));
  EXPECT_FALSE(is_exposed(config));
  config.server_http = "0.0.0.0:8443";
  EXPECT_TRUE(is_exposed(config));
  EXPECT_TRUE(says(check_exposure(config).error().message, "server.http"));
  config.server_http = Config{}.server_http;
  config.server_grpc = "[::]:50051";
  EXPECT_TRUE(says(check_exposure(config).error().message, "server.grpc"));
  config.server_tls_certificate = "c.pem";
  EXPECT_TRUE(says(check_exposure(config).error().message, "--tls-key"));
  config.server_tls_key = "k.pem";
  EXPECT_TRUE(check_exposure(config));
}

TEST(Config, RigKeysMatchRigConfigAndItsRanges) {
  const auto config = parse_config("[rig]\nkeep_out_mm = 12\nslack_mm = 1.5\n", "d.toml");
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->rig.keep_out_mm, 12);
  EXPECT_EQ(config->rig.slack_mm, 1.5);
  EXPECT_TRUE(says(problem("[rig]\n\npoll_period_s = 0.5\n"),
                   "d.toml:3: rig.poll_period_s must be a number from 0.002 to 0.02"));
  EXPECT_TRUE(says(problem("[rig]\nslack_mm = \"1\"\n"), "must be a number"));
  EXPECT_TRUE(says(problem("[rig]\nslack_mm = nan\n"), "must be a number"));
  EXPECT_TRUE(says(problem("[rig]\ndrive = \"usb\"\n"), "d.toml:2: rig.drive: "));
  EXPECT_TRUE(says(problem("[rig]\nkeep_out = 3\n"), "did you mean \"rig.keep_out_mm\""));
}

std::string rig_problem(const Config& config) {
  const auto setup = read_controller_config(config);
  return setup ? "accepted" : setup.error().message;
}

TEST(Config, UnsafeRigIsRefusedWithTheKeysName) {
  Config config;
  EXPECT_FALSE(read_controller_config(config)->has_value()) << "without a drive there is no rig";
  config.rig_drive = "tcp:127.0.0.1:1502";
  EXPECT_TRUE(says(rig_problem(config), "rig.profile is empty"));
  config.rig_profile = testing::drive_profile_path("virtual");
  ASSERT_TRUE(read_controller_config(config));
  EXPECT_TRUE((*read_controller_config(config))->profile.is_virtual);
  config.rig.keep_out_mm = 3;
  EXPECT_TRUE(says(rig_problem(config), "rig.keep_out_mm is 3; it must be at least"));
  config.rig_profile = testing::drive_profile_path("leadshine_em2rs");
  config.rig.keep_out_mm = 30;
  const auto real = read_controller_config(config);
  ASSERT_TRUE(real) << real.error().message;
  EXPECT_FALSE((*real)->profile.is_virtual);
  config.rig_drive = "tcp:nowhere:1502";
  EXPECT_TRUE(says(rig_problem(config), "rig.drive: "));
}

}  // namespace
}  // namespace hydroprint::daemon
