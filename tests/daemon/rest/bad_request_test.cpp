#include "daemon/rest/bad_request.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "daemon/rest/answer.h"

namespace hydroprint::rest {
namespace {

using nlohmann::json;

// The field violations in an error reply.
json field_violations(const Error& error) {
  const json answer = json::parse(error_answer(error).json);
  for (const json& detail : answer["error"]["details"]) {
    if (detail["@type"] == "type.googleapis.com/google.rpc.BadRequest") {
      return detail["fieldViolations"];
    }
  }
  return nullptr;
}

json error_info(const Error& error) {
  return json::parse(error_answer(error).json)["error"]["details"][0];
}

TEST(BadRequest, ListsAllWrongFieldsInOrder) {
  const Error error = bad_request({{"simulate.scale", "is wrong", ErrorReason::SPEC_INVALID},
                                   {"simulate.dpi", "is too large", ErrorReason::SPEC_INVALID}});
  EXPECT_EQ(error.code, Code::kInvalidArgument);
  EXPECT_EQ(full_message(error), "simulate.scale: is wrong; simulate.dpi: is too large");
  EXPECT_EQ(field_violations(error),
            json::parse(R"([{"field": "simulate.scale", "description": "is wrong"},
                            {"field": "simulate.dpi", "description": "is too large"}])"));
}

TEST(BadRequest, ReasonAndFieldComeFromTheFirstViolation) {
  const Error error = bad_request({{"mesh.name", "is wrong", ErrorReason::NAME_INVALID},
                                   {"dpi", "is too large", ErrorReason::SPEC_INVALID}});
  const json info = error_info(error);
  EXPECT_EQ(info["reason"], "NAME_INVALID");
  EXPECT_EQ(info["metadata"], json::parse(R"({"field": "mesh.name"})"));
}

TEST(BadRequest, SingleWrongFieldHasTheSameForm) {
  const Error error{Code::kInvalidArgument, "is too long", ErrorReason::SPEC_INVALID, {}, "ttl"};
  EXPECT_EQ(field_violations(error),
            json::parse(R"([{"field": "ttl", "description": "is too long"}])"));
}

TEST(BadRequest, OtherErrorsNameNoFields) {
  EXPECT_EQ(field_violations({Code::kNotFound, "jobs/7: is gone", ErrorReason::JOB_NOT_FOUND, {}}),
            nullptr);
}

TEST(BadRequest, ManyWrongFieldsFitInAReply) {
  std::vector<rules::Violation> violations;
  for (int i = 0; i < 300; ++i) {
    violations.push_back({"simulate.extra_files[" + std::to_string(i) + "].name",
                          std::string(80, 'x'), ErrorReason::NAME_INVALID});
  }
  const json shown = field_violations(bad_request(violations));
  EXPECT_EQ(shown.size(), 16U);
  EXPECT_EQ(shown[15]["field"], "simulate.extra_files[15].name");
}

}  // namespace
}  // namespace hydroprint::rest
