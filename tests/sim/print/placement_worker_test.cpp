// The verb template. Other programs read its page, and the tests measure the result.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>

#include "tests/sim/print/raster_files.h"
#include "tests/support/paths.h"
#include "tests/support/process.h"

namespace hydroprint::print {
namespace {

using testing::Ended;

class Template : public ::testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return folder.path() / name; }
  [[nodiscard]] Ended run(const std::vector<std::string>& more,
                          const std::string& out = "out") const {
    std::vector<std::string> all = {testing::program_path("hydroprint-worker"),
                                    "template",
                                    "--mesh",
                                    path("pyramid.obj"),
                                    "--out",
                                    path(out)};
    all.insert(all.end(), more.begin(), more.end());
    return testing::run(all);
  }
  void SetUp() override {
    // A pyramid on its tip, 60 x 40 mm on top, 50 mm high, its axis at x = 20, y = -30.
    folder.write("pyramid.obj",
                 "v 20 -30 0\nv -10 -50 50\nv 50 -50 50\nv 50 -10 50\nv -10 -10 50\n"
                 "f 1 3 2\nf 1 4 3\nf 1 5 4\nf 1 2 5\nf 2 3 4 5\n");
    folder.write("pose.json", R"({"rotation_wxyz":[1,0,0,0],"translation_mm":[5,7,0]})");
  }
  testing::TemporaryFolder folder;
};

struct Extent {
  double x0 = HUGE_VAL, x1 = -HUGE_VAL, y0 = HUGE_VAL, y1 = -HUGE_VAL;
};

/// Extent of all strokes with this pen, in mm on the page.
Extent extent_of_strokes(const std::string& trace, double pen_mm) {
  Extent out;
  const std::regex stroke("<stroke_path[^>]*linewidth=\"([^\"]+)\"[^]*?</stroke_path>");
  const std::regex point(" x=\"([^\"]+)\" y=\"([^\"]+)\"");
  for (std::sregex_iterator at(trace.begin(), trace.end(), stroke), end; at != end; ++at) {
    if (std::abs(std::stod((*at)[1]) * 25.4 / 72 - pen_mm) > 1e-3) continue;
    const std::string path = at->str();
    for (std::sregex_iterator p(path.begin(), path.end(), point); p != end; ++p) {
      const double x = std::stod((*p)[1]) * 25.4 / 72, y = std::stod((*p)[2]) * 25.4 / 72;
      out = {std::min(out.x0, x), std::max(out.x1, x), std::min(out.y0, y), std::max(out.y1, y)};
    }
  }
  return out;
}

TEST_F(Template, ShowsFirstContactAtThePoseAndAtExactScale) {
  const Ended ended = run({"--pose", path("pose.json")});
  ASSERT_EQ(ended.status, 0) << ended.err;
  const auto report = nlohmann::json::parse(bytes_of(path("out/report.json")));
  EXPECT_NEAR(report["contact_mm"][0], 25, 1e-3);
  EXPECT_NEAR(report["contact_mm"][1], -23, 1e-3);
  // 0.5 mm above its tip, the pyramid has a hundredth of its size at the top.
  EXPECT_NEAR(report["contact_size_mm"][0], 0.6, 1e-3);
  EXPECT_NEAR(report["contact_size_mm"][1], 0.4, 1e-3);
  const std::string trace = traced_by_mupdf(path("out/placement.pdf"));
  const Extent contact = extent_of_strokes(trace, 0.6);
  EXPECT_NEAR(contact.x0, 105 + 25 - 0.3, 1e-2);
  EXPECT_NEAR(contact.x1, 105 + 25 + 0.3, 1e-2);
  // The y coordinates of the page increase upwards, like those of the film.
  EXPECT_NEAR(contact.y0, 148.5 - 23 - 0.2, 1e-2);
  EXPECT_NEAR(contact.y1, 148.5 - 23 + 0.2, 1e-2);
  const Ended info = testing::run({"/usr/bin/pdfinfo", path("out/placement.pdf")});
  EXPECT_NE(info.out.find("Pages:           2"), std::string::npos) << info.out;
}

TEST_F(Template, IsByteIdenticalEveryTime) {
  ASSERT_EQ(run({"--date", "2025-03-14"}, "one").status, 0);
  ASSERT_EQ(run({"--date", "2025-03-14", "--threads", "1"}, "two").status, 0);
  EXPECT_TRUE(bytes_of(path("one/placement.pdf")) == bytes_of(path("two/placement.pdf")));
}

}  // namespace
}  // namespace hydroprint::print
