#include "daemon/rest/path_template.h"

#include <gtest/gtest.h>
#include <regex.h>

#include <memory>
#include <random>
#include <stdexcept>

#include "daemon/rest/percent.h"

namespace hydroprint::rest {
namespace {

using Values = std::vector<std::string>;

// Values of the template's variables in the path; nullopt if the path does not match.
std::optional<Values> values_of(const std::string& path_template, const std::string& path) {
  const auto parsed = parse_template(path_template);
  if (!parsed) throw std::logic_error(parsed.error().message);
  const auto parts = split_path(path);
  if (!parts || !*parts) return std::nullopt;
  return match(*parsed, **parts);
}

TEST(PathTemplate, FollowsTheGrammar) {
  const auto parsed = parse_template("/v1/{a.b_c=jobs/*/x}/*/{d}:do-it");
  ASSERT_TRUE(parsed) << parsed.error().message;
  EXPECT_EQ(parsed->segments.size(), 6U);
  EXPECT_EQ(parsed->verb, "do-it");
  ASSERT_EQ(parsed->variables.size(), 2U);
  EXPECT_EQ(parsed->variables[0].field_path, "a.b_c");
  EXPECT_EQ(parsed->variables[0].begin, 1U);
  EXPECT_EQ(parsed->variables[0].end, 4U);
  EXPECT_EQ(parsed->variables[1].field_path, "d");
}

TEST(PathTemplate, OtherTextIsRefused) {
  for (const char* text :
       {"",      "v1",       "/",     "/v1/",    "//v1",  "/v1:",      "/v1:a:b",   "/v1:a/b",
        "/{}",   "/{a",      "/{a=}", "/{a=b/}", "/{=b}", "/{a..b}",   "/{.a}",     "/{a.}",
        "/{1a}", "/{a={b}}", "/a{b}", "/{a}b",   "/**/a", "/{a=**}/b", "/{a=**/b}", "/a*",
        "/***",  "/*a",      "/a b",  "/%",      "/%2",   "/%zz",      "/%00",      "/{a}/{a}",
        "/a}",   "/é",       "/{a}:", "/a?b",    "/:a"}) {
    EXPECT_FALSE(parse_template(text)) << text;
  }
}

TEST(PathTemplate, VerbIsNotPartOfTheLastVariable) {
  EXPECT_EQ(values_of("/v1/{name=jobs/*}:cancel", "/v1/jobs/7:cancel"), Values{"jobs/7"});
  EXPECT_EQ(values_of("/v1/{name=jobs/*}", "/v1/jobs/7:cancel"), std::nullopt);
  EXPECT_EQ(values_of("/v1/{name=jobs/*}:cancel", "/v1/jobs/7"), std::nullopt);
  EXPECT_EQ(values_of("/v1/{name=**}:cancel", "/v1/a/b:cancel"), Values{"a/b"});
  EXPECT_EQ(values_of("/v1/{name=**}:cancel", "/v1:cancel"), Values{""});
  // An encoded colon, or one in an earlier segment, does not begin a verb.
  EXPECT_EQ(values_of("/v1/{name=jobs/*}", "/v1/jobs/7%3Acancel"), Values{"jobs/7:cancel"});
  EXPECT_EQ(values_of("/v1/{name=jobs/*}:cancel", "/v1/jobs/7:8:cancel"), Values{"jobs/7:8"});
  EXPECT_EQ(values_of("/{a}/{b}", "/x:y/z"), (Values{"x:y", "z"}));
  EXPECT_EQ(values_of("/v1/{name}:cancel", "/v1/7:c%61ncel"), Values{"7"});
}

TEST(PathTemplate, SlashStaysEncodedInMultiSegmentVariables) {
  EXPECT_EQ(values_of("/{a}", "/x%2Fy%2fz%20%C3%A9%25"), Values{"x/y/z é%"});
  EXPECT_EQ(values_of("/{a=*}", "/x%2Fy"), Values{"x/y"});
  EXPECT_EQ(values_of("/{a=b/*}", "/b/x%2Fy%2fz%20%C3%A9"), Values{"b/x%2Fy%2fz é"});
  EXPECT_EQ(values_of("/{a=**}", "/x%2Fy"), Values{"x%2Fy"});
  EXPECT_EQ(values_of("/{a=**}", "/x%20y/%7e"), Values{"x y/~"});
  EXPECT_EQ(values_of("/{a}", "/a+b"), Values{"a+b"});
}

TEST(PathTemplate, LiteralsAreComparedDecoded) {
  EXPECT_EQ(values_of("/caf%C3%A9/{a}", "/caf%c3%a9/x"), Values{"x"});
  EXPECT_EQ(values_of("/jobs/{a}", "/%6Aobs/x"), Values{"x"});
  EXPECT_EQ(values_of("/jobs/{a}", "/Jobs/x"), std::nullopt);
}

TEST(PathTemplate, EmptySegmentsAndTrailingSlashesMatchNothing) {
  for (const char* path : {"", "a", "/", "//", "/a/", "/a//b", "//a", "/a:", "/:a"}) {
    EXPECT_EQ(values_of("/{a=**}", path), std::nullopt) << path;
  }
  EXPECT_EQ(values_of("/a/{b=**}", "/a"), Values{""});
}

TEST(PathTemplate, InvalidUrlsAreRefused) {
  for (const char* path : {"/%", "/%4", "/%4/a", "/%zz", "/a%00", "/%c0%af", "/%e0%80%af",
                           "/%ed%a0%80", "/%f4%90%80%80", "/%ff", "/%c3", "/%c3/%a9", "/a b",
                           "/a\tb", "/a#b", "/\xc3\xa9", "/a\x7f", "a%", "//%"}) {
    const auto parts = split_path(path);
    ASSERT_FALSE(parts) << path;
    EXPECT_EQ(parts.error().code, Code::kInvalidArgument);
    EXPECT_EQ(parts.error().reason, ErrorReason::URL_INVALID);
  }
}

// A POSIX regular expression that must match the whole text.
class Regex {
 public:
  explicit Regex(const std::string& pattern) {
    if (regcomp(&regex_, ("^" + pattern + "$").c_str(), REG_EXTENDED) != 0) {
      throw std::logic_error(pattern);
    }
  }
  ~Regex() { regfree(&regex_); }
  Regex(const Regex&) = delete;
  Regex& operator=(const Regex&) = delete;

  // The texts that match the whole expression (first) and its groups; nullopt if there is no match.
  [[nodiscard]] std::optional<Values> groups(const std::string& text) const {
    regmatch_t found[10];
    if (regexec(&regex_, text.c_str(), std::size(found), found, 0) != 0) return std::nullopt;
    Values values;
    for (const regmatch_t& group : found) {
      const auto length = static_cast<std::size_t>(group.rm_eo - group.rm_so);
      values.push_back(
          group.rm_so < 0 ? "" : text.substr(static_cast<std::size_t>(group.rm_so), length));
    }
    return values;
  }

 private:
  regex_t regex_{};
};

// Random templates of up to three segments from a few words, and all short paths from these words
// and one more.
class Drawn {
 public:
  std::string path_template() {
    std::string text;
    std::string pattern;
    int names = 0;
    groups_.clear();
    std::size_t group = 0;
    for (std::size_t left = 1 + below(3); left > 0;) {
      const bool is_variable = below(2) == 0;
      const std::size_t inner = is_variable ? 1 + below(left) : 1;
      text += is_variable ? std::string("/{v") + std::to_string(names++) + "=" : "/";
      pattern += is_variable ? "(" : "";
      if (is_variable) groups_.push_back(++group);
      for (std::size_t i = 0; i < inner; ++i) {
        const bool is_last = i + 1 == left;
        const std::size_t kind = below(is_last ? 4 : 3);
        static constexpr const char* kTexts[] = {"a", "b", "*", "**"};
        static constexpr const char* kPatterns[] = {"/a", "/b", "/[^/:]+", "(/[^/:]+)*"};
        text += std::string(i == 0 ? "" : "/") + kTexts[kind];
        pattern += kPatterns[kind];
      }
      pattern += is_variable ? ")" : "";
      text += is_variable ? "}" : "";
      left -= inner;
    }
    const bool has_verb = below(3) == 0;
    regex_ = std::make_unique<Regex>(pattern + (has_verb ? ":v" : ""));
    return text + (has_verb ? ":v" : "");
  }

  // Values of the variables according to a regular expression, which does not split the path into
  // segments.
  [[nodiscard]] std::optional<Values> expected(const std::string& path) const {
    const auto found = regex_->groups(path);
    if (!found) return std::nullopt;
    Values values;
    for (const std::size_t group : groups_) {
      const std::string& value = found->at(group);
      values.push_back(value.empty() ? value : value.substr(1));
    }
    return values;
  }

  static std::vector<std::string> paths() {
    std::vector<std::string> all;
    std::vector<std::string> ends = {""};
    for (int length = 1; length <= 4; ++length) {
      std::vector<std::string> longer;
      for (const std::string& end : ends) {
        for (const char* word : {"/a", "/b", "/c"}) longer.push_back(end + word);
      }
      for (const std::string& path : longer) {
        for (const char* verb : {"", ":v", ":w"}) all.push_back(path + verb);
      }
      ends = longer;
    }
    return all;
  }

 private:
  std::size_t below(std::size_t count) { return random_() % count; }

  std::mt19937 random_{7};
  std::unique_ptr<Regex> regex_;
  std::vector<std::size_t> groups_;  // number of the regular expression's group, by variable
};

TEST(PathTemplate, MatchesLikeARegularExpression) {
  Drawn drawn;
  std::size_t matched = 0;
  for (int i = 0; i < 400; ++i) {
    const std::string text = drawn.path_template();
    for (const std::string& path : Drawn::paths()) {
      const auto values = values_of(text, path);
      ASSERT_EQ(values, drawn.expected(path)) << text << " " << path;
      matched += values ? 1 : 0;
    }
  }
  EXPECT_GT(matched, 1000U);
}

TEST(PathTemplate, TwoOverlapIfSomePathMatchesBoth) {
  Drawn drawn;
  const auto paths = Drawn::paths();
  std::vector<PathTemplate> templates;
  std::vector<std::string> texts;
  std::vector<std::vector<bool>> matched;
  for (int i = 0; i < 120; ++i) {
    texts.push_back(drawn.path_template());
    templates.push_back(*parse_template(texts.back()));
    matched.emplace_back();
    for (const std::string& path : paths) {
      matched.back().push_back(match(templates.back(), **split_path(path)).has_value());
    }
  }
  std::size_t overlaps = 0;
  for (std::size_t a = 0; a < templates.size(); ++a) {
    for (std::size_t b = 0; b < templates.size(); ++b) {
      bool expected = false;
      for (std::size_t i = 0; i < paths.size(); ++i) expected |= matched[a][i] && matched[b][i];
      ASSERT_EQ(overlap(templates[a], templates[b]), expected) << texts[a] << " " << texts[b];
      overlaps += expected ? 1 : 0;
    }
  }
  EXPECT_GT(overlaps, templates.size());
}

}  // namespace
}  // namespace hydroprint::rest
