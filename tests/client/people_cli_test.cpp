// `hydroprint` with user accounts, and the real daemon.
#include "tests/client/people_cli.h"

#include <sys/stat.h>

#include <fstream>

#include "tests/support/paths.h"

namespace hydroprint::tests {
namespace {

TEST_F(PeopleCli, LoginStoresAKeyThatEveryCommandUses) {
  add("ann", "ADMIN");
  const Outcome refused = client({"list"});
  EXPECT_EQ(refused.status, 3);
  EXPECT_NE(refused.err.find("hydroprint login"), std::string::npos) << refused.err;
  log_in("ann");
  struct stat info {};
  ASSERT_EQ(::stat(credentials().c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777, 0600U);
  EXPECT_EQ(content(credentials()).find(kPassword), std::string::npos);
  EXPECT_EQ(client_json({"whoami"}).at("role"), "ADMIN");
  EXPECT_EQ(client({"list"}).status, 0);
  // login ends the session that it used
  EXPECT_TRUE(client_json({"sessions", "list"}).at("sessions").empty());
}

TEST_F(PeopleCli, LogoutRevokesTheKey) {
  add("ann", "ADMIN");
  log_in("ann");
  const std::string kept = content(credentials());
  ASSERT_EQ(client({"logout"}).status, 0);
  EXPECT_EQ(content(credentials()).find("hp_"), std::string::npos);
  EXPECT_EQ(client({"list"}).status, 3);
  const std::size_t from = kept.find("hp_");
  const std::string key = kept.substr(from, kept.find_first_of("'\"", from) - from);
  EXPECT_EQ(client({"list"}, {"HYDROPRINT_API_KEY=" + key}).status, 3);
  EXPECT_EQ(client({"logout"}).status, 3);
}

TEST_F(PeopleCli, AKeyFromTheEnvironmentTakesPrecedence) {
  add("ann", "ADMIN");
  log_in("ann");
  const std::string key =
      client_json({"keys", "add", "--name", "nightly", "--role", "viewer", "--days", "2"})
          .at("key");
  EXPECT_EQ(client_json({"whoami"}, {"HYDROPRINT_API_KEY=" + key}).at("role"), "VIEWER");
  EXPECT_EQ(client({"queue", "pause"}, {"HYDROPRINT_API_KEY=" + key}).status, 3);
  EXPECT_EQ(client_json({"whoami"}).at("role"), "ADMIN");
  EXPECT_EQ(client({"whoami"}, {"HYDROPRINT_API_KEY=hp_no_key"}).status, 3);
}

TEST_F(PeopleCli, ALinkLogsInOnce) {
  add("ann", "ADMIN");
  log_in("ann");
  const std::string token = client_json({"users", "link", "ann"}).at("token");
  EXPECT_EQ(client({"logout"}).status, 0);
  const std::string link = "http://127.0.0.1:8080/sign-in#" + token + "\n";
  EXPECT_EQ(told(link, {"login", "--link-stdin"}).status, 0);
  EXPECT_EQ(client_json({"whoami"}).at("user"), "ann");
  EXPECT_EQ(client({"logout"}).status, 0);
  EXPECT_EQ(told(link, {"login", "--link-stdin"}).status, 3) << "the link was already used";
}

TEST_F(PeopleCli, AWrongPasswordOrKeyIsNotStored) {
  add("ann", "ADMIN");
  const Outcome ended = told("wrong password\n", {"login", "--user", "ann"});
  EXPECT_EQ(ended.status, 3);
  EXPECT_NE(ended.err.find("wrong"), std::string::npos);
  EXPECT_EQ(told("hp_no_key\n", {"login", "--api-key-stdin"}).status, 3);
  EXPECT_FALSE(std::filesystem::exists(credentials()));
}

TEST_F(PeopleCli, KeysThatOthersCanReadAreRefused) {
  add("ann", "ADMIN");
  log_in("ann");
  ::chmod(credentials().c_str(), 0644);
  const Outcome ended = client({"list"});
  EXPECT_EQ(ended.status, 3);
  EXPECT_NE(ended.err.find("credentials.toml"), std::string::npos) << ended.err;
}

TEST_F(PeopleCli, APasswordIsNotShownAndTheTerminalIsRestored) {
  add("ann", "ADMIN");
  Terminal terminal(command({"login"}));
  ASSERT_TRUE(terminal.shows("Name: "));
  terminal.type("ann\n");
  ASSERT_TRUE(terminal.shows("Password: "));
  terminal.type(std::string(kPassword) + "\n");
  EXPECT_TRUE(terminal.shows("ann is ADMIN"));
  EXPECT_EQ(terminal.wait(), 0);
  EXPECT_EQ(terminal.screen().find(kPassword), std::string::npos);
  EXPECT_TRUE(terminal.is_cooked());
}

TEST_F(PeopleCli, CtrlCAtThePasswordRestoresTheTerminal) {
  add("ann", "ADMIN");
  Terminal terminal(command({"login", "--user", "ann"}));
  ASSERT_TRUE(terminal.shows("Password: "));
  terminal.type("half of i\x03");
  EXPECT_EQ(terminal.wait(), 130);
  EXPECT_TRUE(terminal.is_cooked());
  EXPECT_FALSE(std::filesystem::exists(credentials()));
}

TEST_F(PeopleCli, AnAdminAddsChangesAndDeletesUsers) {
  add("ann", "ADMIN");
  log_in("ann");
  add("mae", "maker");
  EXPECT_EQ(client({"users", "set", "mae", "--role", "operator", "--disable"}).status, 0);
  const json users = client_json({"users", "list"}).at("users");
  ASSERT_EQ(users.size(), 2U);
  EXPECT_EQ(users[1].at("name"), "users/mae");
  EXPECT_EQ(users[1].at("role"), "OPERATOR");
  EXPECT_EQ(users[1].at("disabled"), true);
  EXPECT_EQ(client_json({"users", "link", "mae"}).at("token").get<std::string>().size(), 64U);
  EXPECT_EQ(client({"users", "delete", "mae"}).status, 0);
  EXPECT_EQ(client({"users", "delete", "ann"}).status, 3);  // the last admin
  const json entries = client_json({"audit", "--what", "PeopleService.DeleteUser"}).at("entries");
  ASSERT_EQ(entries.size(), 2U);
  EXPECT_EQ(entries[0].at("outcome"), "FAILED_PRECONDITION");
  EXPECT_EQ(entries[1].at("who"), "ann");
  EXPECT_EQ(entries[1].at("object"), "users/mae");
}

TEST_F(PeopleCli, JobsBelongToTheirUserAndCanBeShared) {
  add("ann", "ADMIN");
  log_in("ann");
  const std::string mesh = folder_.write("m.obj", "x").string();
  const std::string name = client_json({"submit", "simulate", "--mesh", mesh}).at("name");
  const json mine = client_json({"list", "--mine"}).at("jobs");
  ASSERT_EQ(mine.size(), 1U);
  EXPECT_EQ(mine[0].at("owner"), "ann");
  EXPECT_EQ(mine[0].at("shared"), false);
  EXPECT_EQ(client({"share", name}).status, 0);
  EXPECT_EQ(client_json({"show", name}).at("shared"), true);
  EXPECT_EQ(client({"share", name, "--off"}).status, 0);
  EXPECT_EQ(client_json({"show", name}).at("shared"), false);
}

TEST_F(PeopleCli, WhoamiShowsUsageAndPinnedJobs) {
  add("ann", "ADMIN");
  log_in("ann");
  const std::string mesh = folder_.write("m.obj", "mesh").string();
  const std::string name = client_json({"submit", "simulate", "--mesh", mesh, "--wait"}).at("name");
  EXPECT_TRUE(client_json({"show", name}).contains("purgeTime"));
  EXPECT_EQ(client_json({"assets", "list"}).at("assets")[0].at("owners"), json::array({"ann"}));
  const json usage = client_json({"whoami"}).at("usage");
  EXPECT_GT(std::stoll(usage.at("storedBytes").get<std::string>()), 4);
  EXPECT_EQ(usage.at("maxStoredBytes"), std::to_string(20480LL << 20));
  EXPECT_EQ(usage.at("maxQueuedJobs"), "200");
  EXPECT_EQ(usage.at("pinnedBytes"), "0");
  const Outcome words = client({"whoami"});
  EXPECT_NE(words.out.find("queued: 0 of 200 jobs"), std::string::npos) << words.out;
  EXPECT_EQ(client({"pin", name}).out, name + " is pinned\n");
  EXPECT_EQ(client_json({"show", name}).at("pinned"), true);
  EXPECT_FALSE(client_json({"show", name}).contains("purgeTime"));
  EXPECT_NE(client_json({"whoami"}).at("usage").at("pinnedBytes"), "0");
  EXPECT_NE(client({"unpin", name}).out.find("will be deleted on "), std::string::npos);
}

TEST_F(PeopleCli, AReturningUserGetsJobsAndFilesBack) {
  add("ann", "ADMIN");
  log_in("ann");
  add("mae", "MAKER");
  const std::string key = client_json({"keys", "add"}).at("key");  // key of ann
  log_in("mae");
  const std::string mesh = folder_.write("m.obj", "mesh").string();
  ASSERT_EQ(client({"submit", "simulate", "--mesh", mesh}).status, 0);
  const Arguments as_ann{"HYDROPRINT_API_KEY=" + key};
  ASSERT_EQ(client({"users", "delete", "mae"}, as_ann).status, 0);
  const Outcome refused = client({"users", "add", "mae", "--role", "maker"}, as_ann);
  EXPECT_EQ(refused.status, 3);
  EXPECT_NE(refused.err.find("--returns"), std::string::npos) << refused.err;
  EXPECT_EQ(client({"users", "add", "mae", "--role", "maker", "--returns"}, as_ann).status, 0);
}

TEST_F(PeopleCli, ThePythonExampleUsesServerAndKeyFromTheEnvironment) {
  add("ann", "ADMIN");
  log_in("ann");
  const std::string key = client_json({"keys", "add"}).at("key");
  const auto run = [&](const std::string& with_key) {
    return hydroprint::testing::run(
        {"/usr/bin/env", "PYTHONPATH=" + testing::build_path("python"), "PYTHONDONTWRITEBYTECODE=1",
         "HYDROPRINT_SERVER=" + daemon_.address(), "HYDROPRINT_API_KEY=" + with_key,
         "/usr/bin/python3", testing::source_path("client/python/submit_and_fetch.py"), "--mesh",
         folder_.write("m.obj", "x").string(), "--out", (folder_.path() / "result").string()});
  };
  EXPECT_NE(run("").err.find("UNAUTHENTICATED"), std::string::npos);
  const Outcome ended = run(key);
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "result" / "film.png"));
}

}  // namespace
}  // namespace hydroprint::tests
