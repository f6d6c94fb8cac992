// What a request asks for: queries and bodies, by the rules of google/api/http.proto and the proto3
// JSON mapping.
#include <google/protobuf/util/json_util.h>
#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

#include <map>

#include "daemon/rest/transcoder.h"
#include "tests/daemon/rest/rules/rules.pb.h"

namespace hydroprint::rest {
namespace {

using test::Everything;

const Transcoder& rules() {
  static const auto made = Transcoder::make({"hydroprint.rest.test.Rules"});
  if (!made) throw std::logic_error(made.error().message);
  return *made;
}

// The request that was read, as JSON of what is set; else the reason and what is wrong.
std::string read(const std::string& http_method, const std::string& target,
                 const std::string& body = "") {
  const auto call = rules().read(http_method, target, body);
  if (!call) {
    EXPECT_EQ(call.error().code, Code::kInvalidArgument) << call.error().message;
    EXPECT_EQ(call.error().message.find('\n'), std::string::npos) << call.error().message;
    EXPECT_LT(call.error().message.size(), 400U);
    return call.error().reason + " " + call.error().message;
  }
  Everything request;
  EXPECT_TRUE(request.ParseFromString(call->request));
  std::string text;
  EXPECT_TRUE(google::protobuf::util::MessageToJsonString(request, &text).ok());
  return text;
}

std::string query(const std::string& text) { return read("GET", "/r/query?" + text); }
std::string body(const std::string& text) { return read("POST", "/r/all", text); }

TEST(Query, EachTypeIsReadAsInJson) {
  const std::map<std::string, std::string> cases = {
      {"text=a%20b+c%2B", R"({"text":"a b c+"})"},
      {"text=", "{}"},
      {"maybeText=", R"({"maybeText":""})"},
      {"truth=true", R"({"truth":true})"},
      {"truth=false", "{}"},
      {"small=-2147483648", R"({"small":-2147483648})"},
      {"small=007", R"({"small":7})"},
      {"large=9223372036854775807", R"({"large":"9223372036854775807"})"},
      {"smallCount=4294967295", R"({"smallCount":4294967295})"},
      {"largeCount=18446744073709551615", R"({"largeCount":"18446744073709551615"})"},
      {"zigzag=-5&fixed=6", R"({"zigzag":-5,"fixed":"6"})"},
      {"real=-1.5e3&single=.5", R"({"single":0.5,"real":-1500})"},
      {"raw=AP_-", R"({"raw":"AP/+"})"},
      {"raw=AP8%3D", R"({"raw":"AP8="})"},
      {"colour=RED", R"({"colour":"RED"})"},
      {"colour=-7", R"({"colour":"BLUE"})"},
      {"time=2026-01-02T03:04:05Z", R"({"time":"2026-01-02T03:04:05Z"})"},
      {"time=2026-01-02T03:04:05%2B01:00", R"({"time":"2026-01-02T02:04:05Z"})"},
      {"span=-1.5s", R"({"span":"-1.500s"})"},
      {"mask=text,innerText", R"({"mask":"text,innerText"})"},
      {"boolValue=false&stringValue=&int64Value=-7&doubleValue=0.5&bytesValue=AA==",
       R"({"boolValue":false,"stringValue":"","int64Value":"-7","doubleValue":0.5,"bytesValue":"AA=="})"},
      {"numbers=3&numbers=1&numbers=3", R"({"numbers":[3,1,3]})"},
      {"texts=b&texts=&texts=a", R"({"texts":["b","","a"]})"},
      {"raws=AA==&raws=AQ==", R"({"raws":["AA==","AQ=="]})"},
      {"colours=RED&colours=0", R"({"colours":["RED","COLOUR_UNSPECIFIED"]})"},
      {"times=1970-01-01T00:00:00Z&times=1970-01-01T00:00:01Z",
       R"({"times":["1970-01-01T00:00:00Z","1970-01-01T00:00:01Z"]})"},
      {"inner.text=x&inner.deeper.seq=4&inner.deeper.deeper.text=y",
       R"({"inner":{"text":"x","deeper":{"seq":"4","deeper":{"text":"y"}}}})"},
      {"maybe_text=x&small_count=1", R"({"smallCount":1,"maybeText":"x"})"},
      {"odd_name=x", R"({"whatElse":"x"})"},
      {"whatElse=x", R"({"whatElse":"x"})"},
      {"inner%2Etext=x", R"({"inner":{"text":"x"}})"},
      {"both.text=x&both.seq=1", R"({"both":{"text":"x","seq":"1"}})"},
      {"&&text=x&", R"({"text":"x"})"},
      {"text=a=b?c", R"({"text":"a=b?c"})"},
  };
  for (const auto& [text, expected] : cases) EXPECT_EQ(query(text), expected) << text;
  EXPECT_EQ(read("GET", "/r/query?"), "{}");
}

TEST(Query, WhatIsNoValueIsRefusedByName) {
  const std::map<std::string, std::string> cases = {
      {"truth=1", R"(truth: "1" is not "true" or "false")"},
      {"truth=True", R"(truth: "True" is not "true" or "false")"},
      {"small=2147483648", R"(small: "2147483648" is not a number that fits, int32)"},
      {"small=", R"(small: "" is not a number that fits, int32)"},
      {"small=+1", R"(small: " 1" is not a number that fits, int32)"},
      {"small=1.0", R"(small: "1.0" is not a number that fits, int32)"},
      {"small=0x10", R"(small: "0x10" is not a number that fits, int32)"},
      {"smallCount=-1", R"(small_count: "-1" is not a number that fits, uint32)"},
      {"real=nan", R"(real: "nan" is not a number that fits, double)"},
      {"real=Infinity", R"(real: "Infinity" is not a number that fits, double)"},
      {"real=1e999", R"(real: "1e999" is not a number that fits, double)"},
      {"doubleValue=NaN", R"(double_value: "NaN" is not a DoubleValue)"},
      {"single=1e39", R"(single: "1e39" is not a number that fits, float)"},
      {"reals=1&reals=inf", R"(reals: "inf" is not a number that fits, double)"},
      {"colour=GREEN", R"(colour: "GREEN" is not a name or number of Colour)"},
      {"colour=red", R"(colour: "red" is not a name or number of Colour)"},
      {"colour=77", R"(colour: "77" is not a name or number of Colour)"},
      {"raw=!!", R"(raw: "!!" is not base64)"},
      {"time=yesterday", R"(time: "yesterday" is not a Timestamp)"},
      {"time=2026-01-02T03:04:05+01:00", R"(time: "2026-01-02T03:04:05 01:00" is not a Timestamp)"},
      {"span=5", R"(span: "5" is not a Duration)"},
      {"text", R"(text: "=" is missing)"},
      {"text=a&text=a", "text: is given twice"},
      {"small_count=1&smallCount=1", "small_count: is given twice"},
      {"inner.text=a&inner.text=b", "inner.text: is given twice"},
      {"time=1970-01-01T00:00:00Z&time=1970-01-01T00:00:00Z", "time: is given twice"},
      {"left=a&right=1", "right: excludes left, which is given, too"},
      {"both.text=a&left=", "left: excludes both, which is given, too"},
      {"name=x", "name: the request has no such field"},
      {"Text=x", "Text: the request has no such field"},
      {"=x", ": the request has no such field"},
      {"inner.name=x", "inner.name: the request has no such field"},
      {"inner.=x", "inner.: the request has no such field"},
      {".text=x", ".text: the request has no such field"},
      {"text.text=x", "text.text: the request has no such field"},
      {"time.seconds=1", "time.seconds: the request has no such field"},
      {"inners.text=1", "inners.text: the request has no such field"},
      {"inner=x", "inner: is a message and has no place in a URL"},
      {"inners=x", "inners: is a message and has no place in a URL"},
      {"labels=x", "labels: is a map and has no place in a URL"},
      {"$alt=json", "$alt: the request has no such field"},
  };
  for (const auto& [text, expected] : cases) {
    EXPECT_EQ(query(text), "PARAMETER_INVALID " + expected) << text;
  }
  const auto call = rules().read("GET", "/r/query?inner.seq=x", "");
  EXPECT_EQ(call.error().metadata.at("field"), "inner.seq");
}

TEST(Query, WhatIsNoUrlIsRefused) {
  for (const char* text : {"text=%", "text=%4", "text=%zz", "text=%00", "text=%c0%80", "t%65xt=%ff",
                           "%00=x", "text=a b", "text=\xc3\xa9", "text=a#b", "text=%ed%a0%80"}) {
    EXPECT_EQ(query(text).substr(0, 11), "URL_INVALID") << text;
  }
}

TEST(Query, WhatPathOrBodyGiveIsRefused) {
  EXPECT_EQ(read("GET", "/r/single/a?text=a"), "PARAMETER_INVALID text: is given by the path");
  EXPECT_EQ(read("PUT", "/r/all/a/1?inner.text=a"),
            "PARAMETER_INVALID inner.text: is given by the path");
  EXPECT_EQ(read("POST", "/r/all?text=a"), "PARAMETER_INVALID text: belongs into the body");
  EXPECT_EQ(read("PATCH", "/r/part/a?inner.text=a"),
            "PARAMETER_INVALID inner.text: belongs into the body");
  EXPECT_EQ(read("PATCH", "/r/part/a?inner=a"), "PARAMETER_INVALID inner: belongs into the body");
  EXPECT_EQ(read("PATCH", "/r/part/a?both.text=b", "{}"),
            R"({"text":"a","inner":{},"both":{"text":"b"}})");
}

TEST(Path, ItsVariablesAreFieldsOfAnyType) {
  EXPECT_EQ(read("GET", "/r/typed/true/-7/0.5/RED/AA=="),
            R"({"truth":true,"large":"-7","real":0.5,"raw":"AA==","colour":"RED"})");
  EXPECT_EQ(read("GET", "/r/typed/yes/-7/0.5/RED/AA=="),
            R"(PARAMETER_INVALID truth: "yes" is not "true" or "false")");
  EXPECT_EQ(read("GET", "/r/typed/true/-7/nan/RED/AA=="),
            R"(PARAMETER_INVALID real: "nan" is not a number that fits, double)");
  EXPECT_EQ(read("GET", "/r/several/things/a%2Fb/and/c%2Fd:verb"),
            R"({"text":"things/a%2Fb","whatElse":"c/d"})");
  EXPECT_EQ(read("DELETE", "/r/several/things/7"), R"({"text":"things/7"})");
  EXPECT_EQ(read("GET", "/r/rest/a/b/c:go?small=1"), R"({"text":"a/b/c","small":1})");
  EXPECT_EQ(read("GET", "/r/rest:go"), "{}");
  EXPECT_EQ(read("GET", "/r/caf%C3%A9/any"), "{}");
}

TEST(Body, AllFieldsOrOneOrNone) {
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

TEST(Body, WherePathOrQuerySpeakItIsRefused) {
  EXPECT_EQ(read("PUT", "/r/all/x/5", R"({"inner":{"text":"x"}})"),
            "JSON_INVALID inner.text: is given by the path");
  EXPECT_EQ(read("PUT", "/r/all/x/5", R"({"small":6})"),
            "JSON_INVALID small: is given by the path");
  for (const char* text : {R"({"text":"a"})", "x", "[]", "{}{}", "null"}) {
    EXPECT_EQ(read("GET", "/r/query", text).substr(0, 44),
              "JSON_INVALID the body: none is expected; wha")
        << text;
  }
}

TEST(Body, WhatIsNoJsonIsRefusedWithThePlace) {
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
    EXPECT_EQ(answer.substr(0, 23 + place.size()), "JSON_INVALID the body, " + place) << text;
  }
}

TEST(Body, WhatIsNotOfTheRequestIsRefusedWithTheField) {
  const std::map<std::string, std::string> cases = {
      {"[]", "the body: must be an object, { }"},
      {"null", "the body: must be an object, { }"},
      {"7", "the body: must be an object, { }"},
      {"\"text\"", "the body: must be an object, { }"},
      {R"({"name":"x"})", "name: Everything has no such field"},
      {R"({"inner":{"deeper":{"name":1}}})", "inner.deeper.name: Inner has no such field"},
      {R"({"inners":[{},{"children":[{"x":1}]}]})",
       "inners[1].children[0].x: Inner has no such field"},
      {R"({"text":"a","text":"a"})", "text: is there twice"},
      {R"({"small_count":1,"smallCount":1})", "smallCount: is there twice"},
      {R"({"odd_name":"","whatElse":""})", "whatElse: is there twice"},
      {R"({"inner":{},"inner":{}})", "inner: is there twice"},
      {R"({"labels":{"a":"","a":""}})", "labels.a: is there twice"},
      {R"({"innerByName":{"a":{"seq":1,"seq":1}}})", "innerByName.a.seq: is there twice"},
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
      {R"({"small":true})", "small: must not be a bool"},
      {R"({"large":9007199254740993.0})", "large: must be in quotes to be exact"},
      {R"({"real":"0x1p3"})", "real: must be a finite number"},
      {R"({"real":"NaN"})", "real: must be a finite number"},
      {R"({"real":"-Infinity"})", "real: must be a finite number"},
      {R"({"reals":[1,"Infinity"]})", "reals[1]: must be a finite number"},
      {R"({"doubleValue":"NaN"})", "doubleValue: must be a finite number"},
  };
  for (const auto& [text, expected] : cases) EXPECT_EQ(body(text), "JSON_INVALID " + expected);
  const auto call = rules().read("POST", "/r/all", R"({"inner":{"text":"\u0000"}})");
  EXPECT_EQ(call.error().metadata.at("field"), "inner.text");
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

TEST(Body, ThirtyTwoLevelsAreReadAndNoMore) {
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

TEST(Stream, ItsEventsHaveTheNumberOfTheirMessage) {
  test::Numbered message;
  message.set_seq(9007199254740993);
  const std::string method = "/hydroprint.rest.test.Rules/Stream";
  EXPECT_EQ(rules().event_id(method, message.SerializeAsString()), "9007199254740993");
  EXPECT_EQ(rules().event_id("/hydroprint.rest.test.Rules/PlainStream", ""), "");
  EXPECT_EQ(rules().event_id("/hydroprint.rest.test.Rules/Query", ""), "");
  EXPECT_EQ(rules().event_id("/hydroprint.rest.test.Rules/None", ""), "");
}

TEST(Stream, GoesOnAfterTheLastEvent) {
  const auto call = rules().read("GET", "/r/stream?afterSeq=3&text=a", "");
  ASSERT_TRUE(call);
  EXPECT_TRUE(call->streams);
  const auto resumed = rules().resume(*call, "17");
  ASSERT_TRUE(resumed) << resumed.error().message;
  Everything request;
  ASSERT_TRUE(request.ParseFromString(resumed->request));
  EXPECT_EQ(request.after_seq(), 17);
  EXPECT_EQ(request.text(), "a");
  for (const char* id : {"", "-1", "x", "1x", " 1", "99999999999999999999"}) {
    const auto refused = rules().resume(*call, id);
    ASSERT_FALSE(refused) << id;
    EXPECT_EQ(refused.error().reason, "PARAMETER_INVALID");
  }
  const auto plain = rules().read("GET", "/r/plainStream", "");
  EXPECT_TRUE(rules().resume(*plain, "x"));
}

}  // namespace
}  // namespace hydroprint::rest
