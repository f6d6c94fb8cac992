// The output of --json equals the responses of the REST API.
#include "tests/client/people_cli.h"
#include "tests/daemon/http/http_client.h"

namespace hydroprint::tests {
namespace {

class RestJson : public PeopleCli {
 protected:
  RestJson() {
    add("ann", "ADMIN");
    log_in("ann");
    key_ = client_json({"keys", "add", "--name", "REST"}).at("key");
    const std::string mesh = folder_.write("m.obj", "sleep 0.1").string();
    job_ = client_json({"submit", "simulate", "--mesh", mesh, "--scale", "2", "--wait"}).at("name");
  }

  json rest(const std::string& target) const {
    const HttpAnswer answer =
        ask(daemon_.http(), "GET", "/v1/" + target, "", "Authorization: Bearer " + key_ + "\r\n");
    EXPECT_EQ(answer.status, 200) << answer.body;
    return answer.json();
  }
  void expect_same(const Arguments& arguments, const std::string& target) const {
    EXPECT_EQ(client_json(arguments), rest(target)) << target;
  }

  std::string key_, job_;
};

TEST_F(RestJson, JobsAreThoseOfRest) {
  expect_same({"show", job_}, job_);
  expect_same({"list"}, "jobs");
  expect_same({"list", "--state", "failed"}, "jobs?states=FAILED");
  expect_same({"events", job_}, job_ + "/events");
  expect_same({"artifacts", job_}, job_ + "/artifacts");
  expect_same({"queue", "show"}, "queue");
  EXPECT_EQ(client_json({"show", job_}).at("simulate").at("scale"), 2);
}

TEST_F(RestJson, AListWithALimitHasTheTokenOfTheNextPage) {
  const std::string mesh = folder_.write("m.obj", "sleep 0.2").string();
  client({"submit", "simulate", "--mesh", mesh, "--wait"});
  expect_same({"list", "--limit", "1"}, "jobs?pageSize=1");
  EXPECT_NE(client_json({"list", "--limit", "1"}).at("nextPageToken"), "");
}

TEST_F(RestJson, AssetsAreThoseOfRest) {
  const json assets = client_json({"assets", "list"});
  EXPECT_EQ(assets, rest("assets"));
  const json& asset = assets.at("assets").at(0);
  EXPECT_EQ(asset, rest(asset.at("name")));
  EXPECT_EQ(asset.at("sizeBytes"), "9") << "JSON writes int64 values as text";
}

TEST_F(RestJson, CalibrationsAreThoseOfRest) {
  const std::string mesh = folder_.write("m.obj", "sleep 0.1").string();
  const std::string pose =
      folder_.write("pose.json", R"({"rotation_wxyz":[1,0,0,0],"translation_mm":[1,2,0]})");
  const json entered = client_json({"calibrations", "enter", "--mesh", mesh, "--pose", pose});
  EXPECT_EQ(entered, rest("calibrations/1"));
  EXPECT_EQ(entered.at("scale"), 1);
  expect_same({"calibrations", "show", "active"}, "calibrations/active");
  expect_same({"calibrations", "list"}, "calibrations");
}

TEST_F(RestJson, UsersAndSessionsAreThoseOfRest) {
  add("mae", "MAKER");
  expect_same({"users", "list"}, "users");
  expect_same({"sessions", "list"}, "sessions");
  EXPECT_EQ(client_json({"keys", "list"}).at("apiKeys").size(), 2U);
  json me = client_json({"whoami"});
  EXPECT_EQ(me.at("usage"), rest("usage"));
}

TEST_F(RestJson, WatchPrintsTheMessagesOfTheStream) {
  const Outcome ended = client({"watch", job_, "--json"});
  ASSERT_EQ(ended.status, 0) << ended.err;
  const json message = json::parse(ended.out);
  EXPECT_EQ(message.at("job"), rest(job_));
  EXPECT_TRUE(message.contains("seq"));
}

}  // namespace
}  // namespace hydroprint::tests
