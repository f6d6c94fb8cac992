#include "daemon/http/protocol/header_fields.h"

#include <gtest/gtest.h>

namespace hydroprint::http {
namespace {

TEST(HttpFields, LineEndsAreRejected) {
  HeaderFields fields;
  for (const std::string_view value : {std::string_view("a\r\nX-Evil: 1"), std::string_view("a\nb"),
                                       std::string_view("a\rb"), std::string_view("a\0b", 3)}) {
    EXPECT_FALSE(fields.set("Location", value));
  }
  for (const char* name : {"", "X: 1\r\nY", "a b", "a:", "\xc3\xa9"}) {
    EXPECT_FALSE(fields.set(name, "good"));
  }
  EXPECT_TRUE(fields.all().empty());
  EXPECT_TRUE(fields.set("Location", "a b; c=\"d\""));
}

TEST(HttpFields, NamesAreCaseInsensitive) {
  HeaderFields fields;
  fields.add("coNNection", "keep-alive, Close");
  EXPECT_EQ(fields.find("Connection"), "keep-alive, Close");
  EXPECT_TRUE(fields.lists("CONNECTION", "close"));
  EXPECT_FALSE(fields.lists("Connection", "clos"));
  EXPECT_TRUE(fields.set("Connection", "close"));
  EXPECT_EQ(fields.count("connection"), 1U);
}

TEST(HttpFields, PartsAreTrimmedAndEmptyOnesDropped) {
  EXPECT_EQ(parts_of(" a,, b ,", ','), (std::vector<std::string_view>{"a", "b"}));
  EXPECT_TRUE(parts_of("", ',').empty());
}

}  // namespace
}  // namespace hydroprint::http
