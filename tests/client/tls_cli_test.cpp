// `hydroprint` and the Python example with a daemon that uses TLS.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/daemon/api/support.h"
#include "tests/support/certificates.h"
#include "tests/support/paths.h"
#include "tests/support/process.h"

namespace hydroprint::tests {
namespace {

using hydroprint::testing::Authority;
using hydroprint::testing::KeyPairFiles;
using hydroprint::testing::Wanted;
using Words = std::vector<std::string>;
using Outcome = hydroprint::testing::Ended;

const std::string kProgram = testing::program_path("hydroprint");
constexpr char kSecret[] = "correct horse";

class TlsCli : public ::testing::Test {
 protected:
  void start(const Wanted& wanted = {}, const Words& pair = {}) {
    files.write(authority.issue(wanted));
    DaemonProcess::Options options = DaemonProcess::fake();
    options.arguments = {"--tls-certificate", pair.empty() ? files.certificate.string() : pair[0],
                         "--tls-key", pair.empty() ? files.key.string() : pair[1]};
    options.extra = "[people]\npassword_memory_mib = 1\npassword_passes = 1\n";
    daemon = std::make_unique<DaemonProcess>(folder.path(), options);
  }
  [[nodiscard]] std::string at(const std::string& host) const {
    return host + daemon->address().substr(daemon->address().rfind(':'));
  }
  /// Runs a command in the test's home folder with these variables ("NAME=VALUE") and standard
  /// input.
  Outcome run(const Words& variables, const Words& command, const std::string& lines = "") const {
    Words all{"/bin/sh",
              "-c",
              "printf '%s' '" + lines + "' | \"$0\" \"$@\"",
              "/usr/bin/env",
              "-u",
              "HYDROPRINT_API_KEY",
              "-u",
              "HYDROPRINT_CA",
              "-u",
              "HYDROPRINT_SERVER",
              "XDG_CONFIG_HOME=" + (folder.path() / "config").string()};
    all.insert(all.end(), variables.begin(), variables.end());
    all.insert(all.end(), command.begin(), command.end());
    return hydroprint::testing::run(all);
  }
  Outcome client(Words arguments, const Words& variables = {},
                 const std::string& lines = "") const {
    arguments.insert(arguments.begin(), kProgram);
    return run(variables, arguments, lines);
  }
  void expect_refusal(const Outcome& outcome, const std::string& part) const {
    EXPECT_EQ(outcome.status, 3) << outcome.err;
    EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  }

  TemporaryFolder folder;
  Authority authority;
  std::string ca = folder.write("ca.pem", authority.pem());
  KeyPairFiles files{folder.path()};
  std::unique_ptr<DaemonProcess> daemon;
};

TEST_F(TlsCli, AConfiguredAuthorityIsTrusted) {
  start();
  EXPECT_EQ(client({"--server", at("localhost"), "--ca", ca, "list"}).status, 0);
  EXPECT_EQ(client({"--server", "https://" + at("localhost") + "/", "--ca", ca, "list"}).status, 0);
  EXPECT_EQ(
      client({"list"}, {"HYDROPRINT_SERVER=https://" + at("127.0.0.1"), "HYDROPRINT_CA=" + ca})
          .status,
      0);
}

TEST_F(TlsCli, CertificatesFromMakeCertificateAreTrusted) {
  const std::string out = (folder.path() / "tls").string();
  const auto make = [&] {
    return run({}, {testing::source_path("deploy/make-certificate"), "--out", out, "rig.local"});
  };
  ASSERT_EQ(make().status, 0);
  const std::string made = content(out + "/ca.pem");
  const Outcome again = make();
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(content(out + "/ca.pem"), made) << "a second call uses the existing authority";
  start({{"DNS:localhost"}}, {out + "/certificate.pem", out + "/key.pem"});
  EXPECT_EQ(client({"--server", at("localhost"), "--ca", out + "/ca.pem", "list"}).status, 0);
  EXPECT_EQ(
      run({}, {testing::source_path("deploy/make-certificate"), "--out", out, "rig local"}).status,
      1);
}

TEST_F(TlsCli, AnUntrustedCertificateIsReported) {
  start();
  expect_refusal(client({"--server", "https://" + at("localhost"), "list"}), "--ca FILE");
  const Authority other;
  const std::string file = folder.write("other.pem", other.pem());
  expect_refusal(client({"--server", at("localhost"), "--ca", file, "list"}), "--ca FILE");
}

TEST_F(TlsCli, ACertificateForAnotherNameIsReported) {
  start({{"DNS:rig.example.org"}});
  expect_refusal(client({"--server", at("localhost"), "--ca", ca, "list"}),
                 "is not for the name localhost");
  expect_refusal(client({"--server", at("127.0.0.1"), "--ca", ca, "list"}),
                 "is not for the name 127.0.0.1");
}

TEST_F(TlsCli, AnExpiredCertificateIsReported) {
  start({{"DNS:localhost"}, -9, -1});
  expect_refusal(client({"--server", at("localhost"), "--ca", ca, "list"}), "expired on");
}

TEST_F(TlsCli, TlsOnOnlyOneEndIsReported) {
  start();
  expect_refusal(client({"--server", at("localhost"), "list"}),
                 "use --server https://" + at("localhost"));
  const TemporaryFolder other;
  const DaemonProcess plain(other.path(), DaemonProcess::fake());
  expect_refusal(client({"--server", plain.address(), "--ca", ca, "list"}), "does not speak TLS");
}

TEST_F(TlsCli, AnAuthorityThatCannotBeReadIsRefused) {
  expect_refusal(client({"--ca", "/nonexistent/ca.pem", "list"}), "/nonexistent/ca.pem");
  const std::string file = folder.write("no.pem", "nonsense");
  expect_refusal(client({"--ca", file, "list"}), "no.pem");
}

TEST_F(TlsCli, AMissingServerIsReported) {
  EXPECT_EQ(client({"--server", "https://127.0.0.1:1", "list"}).status, 5);
}

TEST_F(TlsCli, SecretsAreNotSentToAnotherMachineWithoutTls) {
  for (const char* server : {"192.0.2.1:50051", "rig.example.org:50051"}) {
    expect_refusal(client({"--server", server, "list"}, {"HYDROPRINT_API_KEY=hp_a_b"}),
                   "https://" + std::string(server));
    expect_refusal(client({"--server", server, "login", "--user", "ann"}, {}, "correct horse\n"),
                   "https://" + std::string(server));
    expect_refusal(client({"--server", server, "login", "--api-key-stdin"}, {}, "hp_a_b\n"),
                   "https://" + std::string(server));
  }
}

TEST_F(TlsCli, TheServerMustBeHostAndPort) {
  for (const char* bad : {"localhost", "https://", ":1", "localhost:", "localhost:x", "http://a:1",
                          "https://a:1/b", "https://user@a:1", "::1:1", "a:0"}) {
    EXPECT_EQ(client({"--server", bad, "list"}).status, 2) << bad;
  }
}

TEST_F(TlsCli, ThePythonExampleUsesTheStoredKey) {
  start();
  const Words there{"HYDROPRINT_SERVER=https://" + at("localhost"), "HYDROPRINT_CA=" + ca};
  const std::string password = std::string(kSecret) + "\n";
  ASSERT_EQ(
      client({"users", "add", "ann", "--role", "MAKER", "--password"}, there, password).status, 3)
      << "the first user must be an admin";
  ASSERT_EQ(
      client({"users", "add", "ann", "--role", "ADMIN", "--password"}, there, password).status, 0);
  const auto mesh = folder.write("mesh.obj", "");
  const auto example = [&](const Words& variables) {
    Words all = variables;
    all.push_back("PYTHONPATH=" + testing::build_path("python"));
    return run(all, {"/usr/bin/python3", testing::source_path("client/python/submit_and_fetch.py"),
                     "--mesh", mesh.string(), "--out", (folder.path() / "result").string()});
  };
  Outcome ended = example(there);
  EXPECT_NE(ended.status, 0);
  EXPECT_NE(ended.err.find("hydroprint login"), std::string::npos) << ended.err;
  const Outcome in = client({"login", "--user", "ann"}, there, password);
  ASSERT_EQ(in.status, 0) << in.err;
  EXPECT_EQ(client({"list"}, there).status, 0);
  ended = example(there);
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "result" / "film.png"));
  ended = example({there[0]});
  EXPECT_NE(ended.status, 0);
  EXPECT_NE(ended.err.find("HYDROPRINT_CA"), std::string::npos) << ended.err;
  ended = example({"HYDROPRINT_SERVER=rig.example.org:50051", "HYDROPRINT_API_KEY=hp_a_b"});
  EXPECT_NE(ended.status, 0);
  EXPECT_NE(ended.err.find("https://rig.example.org:50051"), std::string::npos) << ended.err;
}

}  // namespace
}  // namespace hydroprint::tests
