// Paths and queries of requests, by the rules of google/api/http.proto.
#include <gtest/gtest.h>

#include <map>

#include "tests/daemon/rest/rules_requests.h"

namespace hydroprint::rest {
namespace {

std::string query(const std::string& text) { return read("GET", "/r/query?" + text); }

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

TEST(Query, InvalidValuesAreRefusedByName) {
  const std::map<std::string, std::string> cases = {
      {"truth=1", R"(truth: "1" is not "true" or "false")"},
      {"truth=True", R"(truth: "True" is not "true" or "false")"},
      {"small=2147483648", R"(small: "2147483648" is not a valid number of type int32)"},
      {"small=", R"(small: "" is not a valid number of type int32)"},
      {"small=+1", R"(small: " 1" is not a valid number of type int32)"},
      {"small=1.0", R"(small: "1.0" is not a valid number of type int32)"},
      {"small=0x10", R"(small: "0x10" is not a valid number of type int32)"},
      {"smallCount=-1", R"(small_count: "-1" is not a valid number of type uint32)"},
      {"real=nan", R"(real: "nan" is not a valid number of type double)"},
      {"real=Infinity", R"(real: "Infinity" is not a valid number of type double)"},
      {"real=1e999", R"(real: "1e999" is not a valid number of type double)"},
      {"doubleValue=NaN", R"(double_value: "NaN" is not a DoubleValue)"},
      {"single=1e39", R"(single: "1e39" is not a valid number of type float)"},
      {"reals=1&reals=inf", R"(reals: "inf" is not a valid number of type double)"},
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
      {"left=a&right=1", "right: cannot be combined with left; give only one of them"},
      {"both.text=a&left=", "left: cannot be combined with both; give only one of them"},
      {"name=x", "name: Everything has no such field"},
      {"Text=x", "Text: Everything has no such field"},
      {"=x", "Everything has no such field"},
      {"inner.name=x", "inner.name: Inner has no such field"},
      {"inner.=x", "inner.: Inner has no such field"},
      {".text=x", ".text: Everything has no such field"},
      {"text.text=x", "text.text: text has no fields that a URL can set"},
      {"time.seconds=1", "time.seconds: time has no fields that a URL can set"},
      {"inners.text=1", "inners.text: inners has no fields that a URL can set"},
      {"inner=x", "inner: is a message and cannot be in a URL"},
      {"inners=x", "inners: is a message and cannot be in a URL"},
      {"labels=x", "labels: is a map and cannot be in a URL"},
      {"$alt=json", "$alt: Everything has no such field"},
  };
  for (const auto& [text, expected] : cases) {
    EXPECT_EQ(query(text), "PARAMETER_INVALID " + expected) << text;
  }
  std::string deep = "inner";
  for (int i = 0; i < 1000; ++i) deep += ".deeper";
  EXPECT_NE(query(deep + ".text=x").find("...: is nested too deeply"), std::string::npos);
  const auto call = rules().read("GET", "/r/query?inner.seq=x", "");
  EXPECT_EQ(call.error().field, "inner.seq");
}

TEST(Query, InvalidUrlsAreRefused) {
  for (const char* text : {"text=%", "text=%4", "text=%zz", "text=%00", "text=%c0%80", "t%65xt=%ff",
                           "%00=x", "text=a b", "text=\xc3\xa9", "text=a#b", "text=%ed%a0%80"}) {
    EXPECT_EQ(query(text).substr(0, 11), "URL_INVALID") << text;
  }
}

TEST(Query, FieldsOfPathOrBodyAreRefused) {
  EXPECT_EQ(read("GET", "/r/single/a?text=a"),
            "PARAMETER_INVALID text: is already set by the path; leave it out");
  EXPECT_EQ(read("PUT", "/r/all/a/1?inner.text=a"),
            "PARAMETER_INVALID inner.text: is already set by the path; leave it out");
  EXPECT_EQ(read("POST", "/r/all?text=a"), "PARAMETER_INVALID text: belongs in the body");
  EXPECT_EQ(read("PATCH", "/r/part/a?inner.text=a"),
            "PARAMETER_INVALID inner.text: belongs in the body");
  EXPECT_EQ(read("PATCH", "/r/part/a?inner=a"), "PARAMETER_INVALID inner: belongs in the body");
  EXPECT_EQ(read("PATCH", "/r/part/a?both.text=b", "{}"),
            R"({"text":"a","inner":{},"both":{"text":"b"}})");
}

TEST(Path, VariablesMayHaveAnyFieldType) {
  EXPECT_EQ(read("GET", "/r/typed/true/-7/0.5/RED/AA=="),
            R"({"truth":true,"large":"-7","real":0.5,"raw":"AA==","colour":"RED"})");
  EXPECT_EQ(read("GET", "/r/typed/yes/-7/0.5/RED/AA=="),
            R"(PARAMETER_INVALID truth: "yes" is not "true" or "false")");
  EXPECT_EQ(read("GET", "/r/typed/true/-7/nan/RED/AA=="),
            R"(PARAMETER_INVALID real: "nan" is not a valid number of type double)");
  EXPECT_EQ(read("GET", "/r/several/things/a%2Fb/and/c%2Fd:verb"),
            R"({"text":"things/a%2Fb","whatElse":"c/d"})");
  EXPECT_EQ(read("DELETE", "/r/several/things/7"), R"({"text":"things/7"})");
  EXPECT_EQ(read("GET", "/r/rest/a/b/c:go?small=1"), R"({"text":"a/b/c","small":1})");
  EXPECT_EQ(read("GET", "/r/rest:go"), "{}");
  EXPECT_EQ(read("GET", "/r/caf%C3%A9/any"), "{}");
}

}  // namespace
}  // namespace hydroprint::rest
