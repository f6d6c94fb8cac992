// Request bodies, by the rules of google/api/http.proto and the proto3 JSON mapping.
#include <gtest/gtest.h>

#include <map>

#include "tests/daemon/rest/rules_requests.h"

namespace hydroprint::rest {
namespace {

std::string body(const std::string& text) { return read("POST", "/r/all", text); }

TEST(Body, HoldsAllFieldsOneFieldOrNone) {
  EXPECT_EQ(body(R"({"text":"a","small_count":3})"), R"({"text":"a","smallCount":3})");
  EXPECT_EQ(body(R"({"text":null,"texts":null,"inner":null,"time":null,"left":null,"right":1})"),
            R"({"right":1})");
  EXPECT_EQ(body(R"({"small":1e2,"large":"5","largeCount":6,"real":"0.5","colour":1})"),
            R"({"small":100,"large":"5","largeCount":"6","real":0.5,"colour":"RED"})");
  EXPECT_EQ(body(""), "{}");
  EXPECT_EQ(body(" \r\n\t"), "{}");
  EXPECT_EQ(read("PUT", "/r/all/x/5", R"({"inner":{"seq":"1"}})"),
            R"({"small":5,"inner":{"text":"x","seq":"1"}})");
  EXPECT_EQ(read("PATCH", "/r/part/x?small=4", R"({"seq":1})"),
            R"({"text":"x","small":4,"inner":{"seq":"1"}})");
  EXPECT_EQ(read("PATCH", "/r/part/x"), R"({"text":"x"})");
  EXPECT_EQ(read("GET", "/r/query?text=a", " { } "), R"({"text":"a"})");
}

TEST(Body, FieldsOfPathOrQueryAreRefused) {
  EXPECT_EQ(read("PUT", "/r/all/x/5", R"({"inner":{"text":"x"}})"),
            "JSON_INVALID inner.text: is already set by the path; leave it out");
  EXPECT_EQ(read("PUT", "/r/all/x/5", R"({"small":6})"),
            "JSON_INVALID small: is already set by the path; leave it out");
  for (const char* text : {R"({"text":"a"})", "x", "[]", "{}{}", "null"}) {
    EXPECT_EQ(read("GET", "/r/query", text).substr(0, 45),
              "JSON_INVALID request body: must be empty; put")
        << text;
  }
}

TEST(Body, InvalidJsonIsRefusedWithItsPlace) {
  const std::map<std::string, std::string> cases = {
      {"{", "line 1, column 2"},
      {"{\"text\": \"a\",\n \"small\": 1,}", "line 2, column 13"},
      {"{text: \"a\"}", "line 1, column 3"},
      {"{'text': 'a'}", "line 1, column 2"},
      {"{\"text\": 'a'}", "line 1, column 10"},
      {"{\"real\": NaN}", "line 1, column 10"},
      {"{\"real\": Infinity}", "line 1, column 10"},
      {"{\"real\": 1e999}", "line 1, column 14"},
      {"{\"real\": .5}", "line 1, column 10"},
      {"{\"real\": 01}", "line 1, column 11"},
      {"{\"small\": +1}", "line 1, column 11"},
      {"{\"small\": 0x1}", "line 1, column 12"},
      {"{\"texts\": [\"a\",]}", "line 1, column 16"},
      {"{\"text\": \"a\"} x", "line 1, column 15"},
      {"{} {}", "line 1, column 4"},
      {"// a\n{}", "line 1, column 1"},
      {"{/**/}", "line 1, column 2"},
      {"\xef\xbb\xbf{}", "line 1, column 1"},
      {"{\"text\": \"\xff\"}", "line 1, column 11"},
      {"{\"text\": \"\xc0\x80\"}", "line 1, column 11"},
      {"{\"text\": \"\\ud800\"}", "line 1, column"},
      {"{\"text\": \"a\nb\"}", "line 1, column"},
      {std::string("{\"text\": \"a\0b\"}", 15), "line 1, column"},
      {std::string("{}\0", 3), "line 1, column 3"},
      {"tru", "line 1, column"},
  };
  for (const auto& [text, place] : cases) {
    const std::string answer = body(text);
    EXPECT_EQ(answer.substr(0, 27 + place.size()), "JSON_INVALID request body, " + place) << text;
  }
}

TEST(Body, UnknownFieldsAreRefusedByName) {
  const std::map<std::string, std::string> cases = {
      {"[]", "request body: must be an object, { }"},
      {"null", "request body: must be an object, { }"},
      {"7", "request body: must be an object, { }"},
      {"\"text\"", "request body: must be an object, { }"},
      {R"({"name":"x"})", "name: Everything has no such field"},
      {R"({"inner":{"deeper":{"name":1}}})", "inner.deeper.name: Inner has no such field"},
      {R"({"inners":[{},{"children":[{"x":1}]}]})",
       "inners[1].children[0].x: Inner has no such field"},
      {R"({"text":"a","text":"a"})", "text: occurs twice"},
      {R"({"small_count":1,"smallCount":1})", "smallCount: occurs twice"},
      {R"({"odd_name":"","whatElse":""})", "whatElse: occurs twice"},
      {R"({"inner":{},"inner":{}})", "inner: occurs twice"},
      {R"({"labels":{"a":"","a":""}})", "labels.a: occurs twice"},
      {R"({"innerByName":{"a":{"seq":1,"seq":1}}})", "innerByName.a.seq: occurs twice"},
      {R"({"innerByName":{"a":{"name":1}}})", "innerByName.a.name: Inner has no such field"},
      {R"({"text":"a\u0000b"})", "text: NUL is not allowed"},
      {R"({"labels":{"a\u0000":""}})", "labels.a?: NUL is not allowed"},
      {R"({"texts":["","\u0000"]})", "texts[1]: NUL is not allowed"},
      {R"({"colour":77})", "colour: Colour has no value 77"},
      {R"({"colours":["RED",5]})", "colours[1]: Colour has no value 5"},
      {R"({"texts":"a"})", "texts: must be a list, [ ]"},
      {R"({"texts":[["a"]]})", "texts[0]: must not be a list"},
      {R"({"texts":["a",null]})", "texts[1]: must not be null"},
      {R"({"inners":[null]})", "inners[0]: must not be null"},
      {R"({"labels":{"a":null}})", "labels.a: must not be null"},
      {R"({"labels":[]})", "labels: must not be a list"},
      {R"({"text":["a"]})", "text: must not be a list"},
      {R"({"text":{"text":"a"}})", "text: must not be an object"},
      {R"({"time":{"seconds":"1"}})", "time: must not be an object"},
      {R"({"boolValue":{"value":true}})", "boolValue: must not be an object"},
      {R"({"inner":"x"})", "inner: must be an object, { }"},
      {R"({"truth":"true"})", "truth: must be true or false"},
      {R"({"boolValue":"true"})", "boolValue: must be true or false"},
      {R"({"small":true})", "small: must not be true or false"},
      {R"({"large":9007199254740993.0})",
       "large: must be in quotes, because a JSON number may lose digits"},
      {R"({"real":"0x1p3"})", "real: must be a finite number"},
      {R"({"real":"NaN"})", "real: must be a finite number"},
      {R"({"real":"-Infinity"})", "real: must be a finite number"},
      {R"({"reals":[1,"Infinity"]})", "reals[1]: must be a finite number"},
      {R"({"doubleValue":"NaN"})", "doubleValue: must be a finite number"},
  };
  for (const auto& [text, expected] : cases) EXPECT_EQ(body(text), "JSON_INVALID " + expected);
  const auto call = rules().read("POST", "/r/all", R"({"inner":{"text":"\u0000"}})");
  EXPECT_EQ(call.error().field, "inner.text");
}

TEST(Body, ValuesOfAnotherTypeAreRefused) {
  for (const char* text : {R"({"text":1})",
                           R"({"text":{}})",
                           R"({"text":["a"]})",
                           R"({"truth":1})",
                           R"({"truth":"x"})",
                           R"({"small":1.5})",
                           R"({"small":2147483648})",
                           R"({"small":"x"})",
                           R"({"small":true})",
                           R"({"smallCount":-1})",
                           R"({"large":"9223372036854775808"})",
                           R"({"large":1e30})",
                           R"({"real":"x"})",
                           R"({"real":{}})",
                           R"({"single":1e39})",
                           R"({"raw":"!"})",
                           R"({"colour":"GREEN"})",
                           R"({"colour":"red"})",
                           R"({"colour":{}})",
                           R"({"inner":"x"})",
                           R"({"inner":[]})",
                           R"({"inner":1})",
                           R"({"texts":"a"})",
                           R"({"texts":{}})",
                           R"({"labels":[]})",
                           R"({"labels":"a"})",
                           R"({"labels":{"a":1}})",
                           R"({"realByNumber":{"x":1}})",
                           R"({"time":1})",
                           R"({"time":"x"})",
                           R"({"time":{"seconds":"1"}})",
                           R"({"span":"1"})",
                           R"({"mask":7})",
                           R"({"left":"a","right":1})",
                           R"({"inners":[1]})",
                           R"({"texts":[["a"]]})"}) {
    EXPECT_EQ(body(text).substr(0, 12), "JSON_INVALID") << text;
  }
}

TEST(Body, NestingIsLimitedTo32Levels) {
  const auto nested = [](std::size_t levels) {
    std::string text;
    for (std::size_t i = 1; i < levels; ++i) text += i == 1 ? R"({"inner":)" : R"({"deeper":)";
    return text + "{}" + std::string(levels - 1, '}');
  };
  EXPECT_EQ(body(nested(32)), nested(32));
  EXPECT_NE(body(nested(33)).find("is nested more than 32 levels deep"), std::string::npos);
  const std::string deep = body(nested(100000).substr(0, 500000));
  EXPECT_NE(deep.find("is nested more than 32 levels deep"), std::string::npos);
  EXPECT_LT(deep.size(), 400U);
  const auto lists = R"({"texts":)" + std::string(100000, '[');
  EXPECT_EQ(body(lists), "JSON_INVALID texts[0]: must not be a list");
}

}  // namespace
}  // namespace hydroprint::rest
