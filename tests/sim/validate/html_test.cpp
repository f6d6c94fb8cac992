#include "sim/validate/html.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hydroprint::validate {
namespace {

Figure figure(double value, double least, double most, const std::string& unit) {
  return {"f", "a figure", unit, value, Limit{least, most, "why"}};
}

TEST(ReportHtml, EscapesItsInput) {
  Report report;
  Experiment experiment;
  experiment.name = "one";
  experiment.title = "a < b & \"c\"";
  experiment.pictures = {{"p.png", "<script>", 10, 20}};
  report.experiments = {experiment};
  const std::string page = report_html(report, "1.0");
  EXPECT_NE(page.find("a &lt; b &amp; &quot;c&quot;"), std::string::npos);
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_NE(page.find("alt=\"&lt;script&gt;\""), std::string::npos);
}

TEST(ReportHtml, ExplainsTheReferenceAndItsLimits) {
  const std::string page = report_html({}, "1.0");
  EXPECT_NE(page.find("A finer computation stands for the physical experiment"), std::string::npos);
  EXPECT_NE(page.find("It cannot show"), std::string::npos);
  for (const char* unknown : {"activator", "trapped air", "the person who lays the film"}) {
    EXPECT_NE(page.find(unknown), std::string::npos) << unknown;
  }
}

TEST(ReportHtml, LimitsAreInPlainEnglish) {
  EXPECT_EQ(limit_text(figure(1, 0, 0.15, "mm")), "at most 0.15 mm");
  EXPECT_EQ(limit_text(figure(1, 3, 1e300, "")), "at least 3");
  EXPECT_EQ(limit_text(figure(1, 0.97, 1.03, "")), "0.97 to 1.03");
  EXPECT_EQ(limit_text(figure(1, 1, 1, "")), "1");
  EXPECT_EQ(limit_text({"f", "a figure", "mm", 1, std::nullopt}), "");
}

TEST(Figure, PassesWithinItsLimitsOrWithoutLimits) {
  EXPECT_TRUE(figure(0.15, 0, 0.15, "mm").passes());
  EXPECT_FALSE(figure(0.16, 0, 0.15, "mm").passes());
  EXPECT_FALSE(figure(std::nan(""), 0, 0.15, "mm").passes());
  EXPECT_TRUE((Figure{"f", "a figure", "mm", 1e9, std::nullopt}.passes()));
}

}  // namespace
}  // namespace hydroprint::validate
