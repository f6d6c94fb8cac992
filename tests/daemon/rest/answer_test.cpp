#include "daemon/rest/answer.h"

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "daemon/rest/status.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"

namespace hydroprint::rest {
namespace {

using nlohmann::json;

TEST(ErrorAnswer, HasTheHttpStatusOfItsCode) {
  // The HTTP status of each google.rpc.Code, by its number.
  const int expected[] = {200, 499, 500, 400, 504, 404, 409, 403, 429,
                          400, 409, 400, 501, 500, 503, 500, 401};
  for (int code = 0; code < 17; ++code) EXPECT_EQ(http_status(code), expected[code]) << code;
  EXPECT_EQ(http_status(-1), 500);
  EXPECT_EQ(http_status(17), 500);
}

TEST(ErrorAnswer, HasAllDetailsOfTheError) {
  Error error{Code::kNotFound,
              "jobs/7: there is no such job",
              ErrorReason::JOB_NOT_FOUND,
              {{"job", "jobs/7"}}};
  const Answer answer = error_answer(error);
  EXPECT_EQ(answer.http_status, 404);
  EXPECT_EQ(json::parse(answer.json), json::parse(R"({"error": {
    "code": 404, "message": "jobs/7: there is no such job", "status": "NOT_FOUND",
    "details": [{"@type": "type.googleapis.com/google.rpc.ErrorInfo", "reason": "JOB_NOT_FOUND",
                 "domain": "hydroprint", "metadata": {"job": "jobs/7"}}]}})"));
}

TEST(ErrorAnswer, IsTheSameOverGrpc) {
  const Error error{Code::kResourceExhausted, "too many jobs", ErrorReason::QUEUE_FULL, {}};
  const Answer answer = error_answer(8, error.message, status_details(error));
  EXPECT_EQ(answer.json, error_answer(error).json);
  EXPECT_EQ(answer.http_status, 429);
  const json details = json::parse(answer.json)["error"]["details"];
  ASSERT_EQ(details.size(), 2U);
  EXPECT_EQ(details[1]["@type"], "type.googleapis.com/google.rpc.RetryInfo");
  EXPECT_EQ(details[1]["retryDelay"], "10s");
}

TEST(ErrorAnswer, MethodNotAllowedIs405) {
  const Answer answer =
      error_answer(Error{Code::kUnimplemented, "x", ErrorReason::METHOD_NOT_ALLOWED, {}});
  EXPECT_EQ(answer.http_status, 405);
  EXPECT_EQ(json::parse(answer.json)["error"]["code"], 405);
  EXPECT_EQ(json::parse(answer.json)["error"]["status"], "UNIMPLEMENTED");
  EXPECT_EQ(
      error_answer(Error{Code::kUnimplemented, "x", ErrorReason::STORE_FAILED, {}}).http_status,
      501);
}

TEST(ErrorAnswer, AcceptsMissingAndUnknownDetails) {
  google::rpc::Status unknown;
  unknown.add_details()->set_type_url("type.googleapis.com/some.other.Message");
  google::rpc::ErrorInfo info;
  info.set_reason("SPEC_INVALID");
  unknown.add_details()->PackFrom(info);
  const std::map<std::string, std::size_t> details = {
      {"", 0}, {"\xff\xff", 0}, {unknown.SerializeAsString(), 2}};
  for (const auto& [bytes, count] : details) {
    const json error = json::parse(error_answer(3, "x\n\"y\" \xff", bytes).json)["error"];
    EXPECT_EQ(error["code"], 400);
    EXPECT_EQ(error["status"], "INVALID_ARGUMENT");
    EXPECT_EQ(error["message"], "x\n\"y\" \xef\xbf\xbd");
    EXPECT_EQ(error["details"].size(), count);
  }
  EXPECT_EQ(json::parse(error_answer(99, "x", "").json)["error"]["status"], "UNKNOWN");
}

}  // namespace
}  // namespace hydroprint::rest
