// The routes of the services, and the rules that are refused at start.
#include "daemon/rest/routes.h"

#include <google/protobuf/descriptor.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "daemon/rest/openapi/extra_routes.h"
#include "daemon/rest/transcoder.h"
#include "tests/daemon/rest/requests.h"

namespace hydroprint::rest {
namespace {

std::string refusal_of(const std::string& service) {
  const auto made = Transcoder::make({"hydroprint.rest.test." + service});
  if (made) return "nothing is refused";
  EXPECT_EQ(made.error().code, Code::kInternal);
  return made.error().message;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Routes, InvalidRulesAreRefusedAtStart) {
  const std::map<std::string, std::string> words = {
      {"SamePath", "its path also matches requests for hydroprint.rest.test.SamePath.One"},
      {"SamePathTwice", "its path also matches"},
      {"UnknownVariable", "name: Inner has no such field"},
      {"RepeatedVariable", "texts must be one value"},
      {"MessageVariable", "time must be one value"},
      {"VariableInList", "inners has no fields that a URL can set"},
      {"VariableTwice", "text is bound twice"},
      {"BadTemplate", "} is missing"},
      {"UnknownBody", "name is not a field of the request"},
      {"TextBody", "text must be a single message"},
      {"ListBody", "children must be a single message"},
      {"BodyInPath", "inner is also bound by the path"},
      {"GetWithBody", "GET must not have a body"},
      {"DeleteWithBody", "DELETE must not have a body"},
      {"ClientStreams", "client streaming is not possible"},
      {"BothStream", "client streaming is not possible"},
      {"OwnVerb", "no GET, PUT"},
      {"NoPattern", "no GET, PUT"},
      {"PartOfAnswer", "response_body is not supported"},
      {"StopWithField", "stops motion, so its path must contain the field seq"},
      {"StructRequest", "contains Any, Struct"},
      {"AnyRequest", "contains Any, Struct"},
      {"DeepRequest", "contains Any, Struct"},
      {"Missing", "is not linked in"},
  };
  for (const auto& [service, part] : words) {
    EXPECT_TRUE(contains(refusal_of(service), part)) << service << ": " << refusal_of(service);
  }
}

TEST(Routes, OnePathMayServeDifferentMethods) {
  const auto made = Transcoder::make({"hydroprint.rest.test.OtherMethod"});
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ(made->methods_at("/x/y"), (std::vector<std::string>{"GET", "POST"}));
  EXPECT_EQ(made->methods_at("/x/z?text=7"), (std::vector<std::string>{"GET"}));
  EXPECT_TRUE(made->methods_at("/y").empty());
  EXPECT_TRUE(made->methods_at("/x/%").empty());
}

TEST(Routes, ApiHasAllServices) {
  EXPECT_GE(api_services().size(), 7U);
  ASSERT_TRUE(Transcoder::make()) << Transcoder::make().error().message;
  for (const std::string& name : api_services()) {
    EXPECT_NE(google::protobuf::DescriptorPool::generated_pool()->FindServiceByName(name), nullptr)
        << name;
  }
}

TEST(Routes, EachApiRouteHasOnlyItsOwnMethods) {
  const auto transcoder = Transcoder::make();
  const auto routes = read_routes(api_services());
  ASSERT_TRUE(transcoder && routes);
  ASSERT_GE(routes->size(), 30U);
  for (const Route& route : *routes) {
    const std::string path = some_path(route);
    const auto call = transcoder->read(route.http_method, path, "");
    ASSERT_TRUE(call) << path << ": " << call.error().message;
    EXPECT_EQ(call->method, rpc_name(*route.method)) << path;
    EXPECT_EQ(call->streams, route.method->server_streaming()) << path;
    const auto allowed = transcoder->methods_at(path);
    for (const char* other : {"GET", "PUT", "POST", "DELETE", "PATCH", "HEAD", "OPTIONS", "get"}) {
      if (std::count(allowed.begin(), allowed.end(), other) > 0) continue;
      const auto refused = transcoder->read(other, path, "");
      ASSERT_FALSE(refused) << other << " " << path;
      EXPECT_EQ(refused.error().reason, ErrorReason::METHOD_NOT_ALLOWED);
      EXPECT_EQ(refused.error().code, Code::kUnimplemented);
      EXPECT_EQ(refused.error().metadata.at("allow"), joined(allowed));
    }
  }
}

// Requests that a browser sends on its own must not change anything.
TEST(Routes, OnlyReadingMethodsOfTheApiUseGet) {
  const auto routes = read_routes(api_services());
  ASSERT_TRUE(routes);
  for (const Route& route : *routes) {
    const std::string& name = route.method->name();
    bool reads = false;
    for (const char* word : {"Get", "List", "Watch", "Download", "WhoAmI"}) {
      reads |= name.rfind(word, 0) == 0;
    }
    EXPECT_EQ(route.http_method == "GET", reads) << name;
    const bool deletes = name.rfind("Delete", 0) == 0 || name == "RevokeSession";
    EXPECT_EQ(route.http_method == "DELETE", deletes) << name;
  }
}

TEST(Routes, StopsMotionIsSetOnTheStopCalls) {
  const auto routes = read_routes(api_services());
  ASSERT_TRUE(routes);
  std::set<std::string> stops;
  for (const Route& route : *routes) {
    if (route.stops_motion) stops.insert(route.method->full_name());
  }
  EXPECT_EQ(stops, (std::set<std::string>{"hydroprint.v1.JobService.CancelJob",
                                          "hydroprint.v1.RigService.StopMotion"}));
}

TEST(Routes, StopIgnoresBodyAndQuery) {
  const auto transcoder = Transcoder::make();
  ASSERT_TRUE(transcoder);
  for (const std::string path : {"/v1/rig:stop", "/v1/jobs/7:cancel"}) {
    EXPECT_TRUE(transcoder->stops_motion("POST", path));
    EXPECT_FALSE(transcoder->stops_motion("GET", path));
    const auto plain_stop = transcoder->read("POST", path, "");
    ASSERT_TRUE(plain_stop);
    EXPECT_TRUE(plain_stop->stops_motion);
    for (const std::string& body :
         {std::string(R"({"leaseId":"x"})"), std::string(R"({"name":"jobs/8"})"), std::string("[]"),
          std::string("null"), std::string("{"), std::string("\xef\xbb\xbf{}"),
          std::string("\0\xff", 2), std::string(1000, '[')}) {
      const auto stop = transcoder->read("POST", path, body);
      ASSERT_TRUE(stop) << body << ": " << stop.error().message;
      EXPECT_EQ(stop->request, plain_stop->request) << body;
    }
    for (const char* query : {"?", "?leaseId=x", "?name=jobs/8", "?&=", "?%zz=%00", "?\xff"}) {
      EXPECT_TRUE(transcoder->stops_motion("POST", path + query)) << query;
      const auto stop = transcoder->read("POST", path + query, "");
      ASSERT_TRUE(stop) << query << ": " << stop.error().message;
      EXPECT_EQ(stop->request, plain_stop->request) << query;
    }
  }
  EXPECT_FALSE(transcoder->stops_motion("POST", "/v1/rig:home"));
  EXPECT_FALSE(transcoder->stops_motion("POST", "/v1/nothing:stop"));
}

TEST(Routes, HandWrittenRoutesAreNotInTheApi) {
  const auto transcoder = Transcoder::make();
  ASSERT_TRUE(transcoder);
  for (const OtherRoute& route : other_routes()) {
    const auto call = transcoder->read(route.http_method, route.path, "");
    EXPECT_FALSE(call) << route.http_method << " " << route.path;
  }
}

TEST(Routes, UnknownPathsAreNotFound) {
  const auto transcoder = Transcoder::make();
  ASSERT_TRUE(transcoder);
  for (const char* path : {"",
                           "/",
                           "*",
                           "v1/jobs",
                           "/v1",
                           "/v1/jobs/",
                           "//v1/jobs",
                           "/v1//jobs",
                           "/v1/jobs/7/",
                           "/V1/jobs",
                           "/v1/Jobs",
                           "/v1/jobs:cancel",
                           "/v1/jobs/7:",
                           "/v1/jobs/7:cancel/",
                           "/v1/jobs/7:Cancel",
                           "/v1/jobs/7/:cancel",
                           "/v1/jobs/7/8",
                           "/v1/jobs%2F7",
                           "/v1/rig:stop:stop",
                           "/v1/jobs/7%3Acancel:x",
                           "http://localhost/v1/jobs"}) {
    const auto call = transcoder->read("GET", path, "");
    ASSERT_FALSE(call) << path;
    EXPECT_EQ(call.error().reason, ErrorReason::ROUTE_NOT_FOUND)
        << path << ": " << call.error().message;
    EXPECT_EQ(call.error().code, Code::kNotFound) << path;
    EXPECT_TRUE(transcoder->methods_at(path).empty()) << path;
  }
}

}  // namespace
}  // namespace hydroprint::rest
