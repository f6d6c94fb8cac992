#include "client/uuid.h"

#include <gtest/gtest.h>

#include <regex>

namespace hydroprint::client {
namespace {

TEST(Uuid, HasVersion4AndIsUnique) {
  const std::string uuid = make_uuid();
  const std::regex form("[0-9a-f]{8}-[0-9a-f]{4}-4[0-9a-f]{3}-[89ab][0-9a-f]{3}-[0-9a-f]{12}");
  EXPECT_TRUE(std::regex_match(uuid, form)) << uuid;
  EXPECT_NE(uuid, make_uuid());
}

}  // namespace
}  // namespace hydroprint::client
