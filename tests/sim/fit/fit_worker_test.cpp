// The verb `hydroprint-worker fit` from a user's point of view.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "hydroprint/v1/report.pb.h"
#include "sim/image/io/image_file.h"
#include "sim/ink/ink_of.h"
#include "tests/sim/fit/scene.h"
#include "tests/sim/worker/report_file.h"
#include "tests/support/content.h"
#include "tests/support/names_in.h"
#include "tests/support/paths.h"
#include "tests/support/process.h"

namespace hydroprint::fit {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::content;
using testing::Ended;
using testing::names_in;
using Arguments = std::vector<std::string>;

std::string obj_of(const mesh::Model& model) {
  std::ostringstream out;
  out.precision(17);
  for (const auto& v : model.vertices) out << "v " << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
  for (const auto& t : model.triangles) {
    out << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
  }
  return out.str();
}

std::string csv_of(const std::vector<Point>& points) {
  std::ostringstream out;
  out.precision(17);
  out << "film_x_mm,film_y_mm,X_mm,Y_mm,Z_mm\n";
  for (const Point& p : points) {
    out << p.film_mm.x() << ',' << p.film_mm.y() << ',' << p.surface_mm.x() << ','
        << p.surface_mm.y() << ',' << p.surface_mm.z() << '\n';
  }
  return out.str();
}

film::Profile truth() {
  film::Profile profile;
  profile.swelling = {1.05, 1.02};
  profile.drag_length_mm = 30;
  return profile;
}

/// Inputs small enough for fast fits at the default settings: a ball of 12 mm radius, dipped 14 mm
/// deep into a film of 60 x 70 mm, of which nearly half is black.
class FitWorker : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    testing::Scene scene{sample::icosphere(12, 3), {}};
    scene.dip.outline = film::parse_outline("60x70").value();
    scene.dip.depth_mm = 14;
    image::RgbImage film{60, 70, std::vector<std::uint8_t>(3 * 60 * 70, 255)};
    for (int y = 0; y < film.height; ++y) {
      for (int x = 32; x < film.width; ++x) std::fill_n(film.at(x, y), 3, std::uint8_t{0});
    }
    scene.dip.ink = ink::ink_of(film, scene.dip.outline, {}, {}).value();
    inputs = new testing::TemporaryFolder;
    inputs->write("ball.obj", obj_of(scene.model));
    inputs->write("measured.csv", csv_of(testing::measured(scene, truth(), 0.7, 0.05, 3, 2.5)));
    ASSERT_TRUE(image::write_png(inputs->path() / "film.png", film, 25.4));
  }
  static void TearDownTestSuite() { delete inputs; }

  /// Output of a fit of the drag with two threads; run once and shared by the tests.
  static const fs::path& drag_fit() {
    static const fs::path out = inputs->path() / "drag";
    static const int status =
        testing::run(command({"--free", "drag", "--out", out.string()})).status;
    EXPECT_EQ(status, 0);
    return out;
  }

  [[nodiscard]] static std::string input(const std::string& name) { return inputs->path() / name; }
  [[nodiscard]] std::string out(const std::string& name = "out") const {
    return folder.path() / name;
  }
  [[nodiscard]] static Arguments command(const Arguments& more, bool with_points = true) {
    Arguments all = {testing::program_path("hydroprint-worker"),
                     "fit",
                     "--mesh",
                     input("ball.obj"),
                     "--film",
                     "60x70",
                     "--depth-mm",
                     "14",
                     "--threads",
                     "2"};
    if (with_points) all.insert(all.end(), {"--points", input("measured.csv")});
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  /// Same as command(), with --out added if `more` does not contain it.
  [[nodiscard]] Arguments fit(const Arguments& more = {}, bool with_points = true) const {
    Arguments all = command(more, with_points);
    const bool has_out = std::find(more.begin(), more.end(), "--out") != more.end();
    if (!has_out) all.insert(all.end(), {"--out", out()});
    return all;
  }
  [[nodiscard]] static json report_in(const fs::path& folder) {
    return json::parse(content(folder / "report.json"));
  }
  [[nodiscard]] json report(const std::string& name = "out") const { return report_in(out(name)); }
  void expect_refusal(int status, const Arguments& command, const std::string& words) const {
    const auto before = names_in(folder.path());
    const Ended ended = testing::run(command);
    EXPECT_EQ(ended.status, status) << ended.err;
    EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
    EXPECT_NE(ended.err.find(words), std::string::npos) << words << " in " << ended.err;
    EXPECT_EQ(names_in(folder.path()), before);
  }

  static testing::TemporaryFolder* inputs;
  testing::TemporaryFolder folder;
};

testing::TemporaryFolder* FitWorker::inputs = nullptr;

json named(const json& list, const std::string& name) {
  for (const json& entry : list) {
    if (entry.at("name") == name) return entry;
  }
  return {};
}

TEST_F(FitWorker, WritesAProfileThatReadsBackAndExplainsThePoints) {
  const Ended ended =
      testing::run(fit({"--free", "drag,swelling", "--ink-image", input("film.png"), "--json"}));
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(names_in(out()), (std::set<std::string>{"film_profile.toml", "report.json",
                                                    "residuals.csv", "residuals.png"}));
  (void)testing::read_message<v1::FitReport>(out() + "/report.json");
  const json fit_found = report();
  ASSERT_EQ(fit_found.at("estimates").size(), 3u);
  const film::Profile profile = film::read_profile(out() + "/film_profile.toml").value();
  EXPECT_EQ(profile.swelling.x(),
            named(fit_found.at("estimates"), "swelling_x").at("value").get<double>());
  EXPECT_EQ(profile.drag_length_mm,
            named(fit_found.at("estimates"), "drag_length_mm").at("value").get<double>());
  EXPECT_EQ(profile.ink_ratio_mm, 0.05) << "a parameter that is not free keeps its value";
  const auto lies_within = [&](const std::string& name, double value) {
    const json estimate = named(fit_found.at("estimates"), name);
    return estimate.at("low") <= value && value <= estimate.value("high", HUGE_VAL);
  };
  EXPECT_TRUE(lies_within("swelling_x", 1.05)) << fit_found;
  EXPECT_TRUE(lies_within("swelling_y", 1.02)) << fit_found;
  EXPECT_TRUE(lies_within("drag_length_mm", 30)) << fit_found;
  for (const char* name : {"young_modulus_mpa", "density_kg_per_m3"}) {
    EXPECT_FALSE(named(fit_found.at("undetermined"), name).is_null()) << name;
  }
  EXPECT_EQ(json::parse(ended.out).at("report"), fit_found);
  // A second fit that starts with the result changes nothing.
  ASSERT_EQ(testing::run(fit({"--free", "drag", "--ink-image", input("film.png"), "--profile",
                              out() + "/film_profile.toml", "--out", out("again")}))
                .status,
            0);
  const json again = report("again");
  EXPECT_NEAR(again.at("rms_before_mm").get<double>(), again.at("rms_after_mm").get<double>(),
              5e-3);
  EXPECT_LT(again.at("rms_after_mm").get<double>(), fit_found.at("rms_before_mm").get<double>());
}

TEST_F(FitWorker, ReportsEveryPointBeforeAndAfter) {
  const fs::path& made = drag_fit();
  std::istringstream lines(content(made / "residuals.csv"));
  std::string header;
  std::getline(lines, header);
  EXPECT_TRUE(header.starts_with("film_x_mm,film_y_mm,X_mm,Y_mm,Z_mm,before_x_mm")) << header;
  int rows = 0, used = 0;
  double before = 0, after = 0;
  for (std::string line; std::getline(lines, line); ++rows) {
    std::vector<std::string> cells;
    std::istringstream in(line);
    for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
    ASSERT_GE(cells.size(), 13u) << line;
    if (cells[11] == "0") {
      EXPECT_GE(cells.size(), 14u) << "an ignored point must have a reason: " << line;
      continue;
    }
    const auto number = [&](int i) { return std::stod(cells[i]); };
    EXPECT_NEAR(number(7), std::hypot(number(5) - number(0), number(6) - number(1)), 1e-9);
    before += number(7) * number(7);
    after += number(10) * number(10);
    ++used;
  }
  const json found = report_in(made);
  EXPECT_EQ(rows, found.at("points").at("given"));
  EXPECT_EQ(used, found.at("points").at("used"));
  EXPECT_NEAR(std::sqrt(before / used), found.at("rms_before_mm").get<double>(), 1e-9);
  EXPECT_NEAR(std::sqrt(after / used), found.at("rms_after_mm").get<double>(), 1e-9);
  EXPECT_LT(after, before);
  const auto picture = image::read_image(made / "residuals.png", {});
  ASSERT_TRUE(picture) << picture.error().message;
  EXPECT_GT(picture->image.width, 1000);
}

TEST_F(FitWorker, ExplainsWhyTheInkRatioIsHeldWithoutAnInkImage) {
  const Ended ended = testing::run(fit({"--free", "ink_ratio"}));
  ASSERT_EQ(ended.status, 0) << ended.err;
  const json ink = named(report().at("undetermined"), "ink_ratio_mm");
  EXPECT_NE(ink.at("reason").get<std::string>().find("printed image"), std::string::npos);
  EXPECT_NE(ended.out.find("ink_ratio_mm is not determined"), std::string::npos) << ended.out;
  EXPECT_EQ(report().at("run").at("warnings").at(0).at("code"), "NOTHING_DETERMINED");
}

TEST_F(FitWorker, ThreadsDoNotChangeTheArtifacts) {
  Arguments alone = fit({"--free", "drag"});
  *std::next(std::find(alone.begin(), alone.end(), "--threads")) = "1";
  ASSERT_EQ(testing::run(alone).status, 0);
  const fs::path one = out(), two = drag_fit();
  for (const char* name : {"film_profile.toml", "residuals.csv", "residuals.png"}) {
    EXPECT_TRUE(content(one / name) == content(two / name)) << name;
  }
  json of_one = report_in(one), of_two = report_in(two);
  for (json* each : {&of_one, &of_two}) each->erase("run");
  EXPECT_EQ(of_one, of_two);
}

TEST_F(FitWorker, BadPointsAreRefusedByLineWithARemedy) {
  const std::string header = "film_x_mm,film_y_mm,X_mm,Y_mm,Z_mm\n";
  const std::vector<std::pair<std::string, std::string>> files = {
      {"film_x_mm,film_y_mm,X_mm,Y_mm\n1,2,3,4\n",
       "bad.csv: line 1: wrong header: column Z_mm is missing"},
      {header + "1,2,3,nan,5\n",
       "bad.csv: line 2: expected 5 finite numbers, but Y_mm is 'nan'. Write film_x_mm"},
      {header + "1,2,3,4,5\n1,2,x,4,5\n",
       "bad.csv: line 3: expected 5 finite numbers, but X_mm is 'x'"},
      {"", "bad.csv: line 1: wrong header"},
      {header, "bad.csv: line 2: no points"},
      {header + "0,0,0,0,-12\n", "bad.csv: too few points: 1 of 1 can be used"},
      {header + "0,0,0,0,-120\n", "more than 1 mm off the object's surface"},
  };
  for (const auto& [csv, words] : files) {
    folder.write("bad.csv", csv);
    expect_refusal(3, fit({"--points", (folder.path() / "bad.csv").string()}, false), words);
  }
  std::string many = header;
  for (std::size_t i = 0; i <= kMostPoints; ++i) many += "0,0,0,0,-12\n";
  folder.write("many.csv", many);
  expect_refusal(3, fit({"--points", (folder.path() / "many.csv").string()}, false),
                 "many.csv: line 20002: too many rows. Use at most 20000");
  expect_refusal(3, fit({"--points", out("absent.csv")}, false), "absent.csv: no such file");
}

TEST_F(FitWorker, BadFlagsAreUsageErrors) {
  expect_refusal(2, fit({}, false), "--points is required");
  expect_refusal(2, fit({"--free", "drag,young_modulus"}), "--free: 'young_modulus'");
  expect_refusal(2, fit({"--model", "stokes"}), "--model");
}

TEST_F(FitWorker, SigtermCancelsAndLeavesNothing) {
  testing::ProcessOptions options;
  options.files = {{5, folder.path() / "progress"}};
  testing::Process process(fit({"--progress-fd", "5"}), options);
  const auto has_begun = [&] {
    return content(folder.path() / "progress").find("\"fit\"") != std::string::npos;
  };
  ASSERT_TRUE(testing::wait_until([&] { return has_begun() || !process.running(); }, 300));
  ASSERT_TRUE(process.running()) << process.wait().err;
  process.signal(SIGTERM);
  const Ended ended = process.wait();
  EXPECT_EQ(ended.status, 130) << ended.err;
  EXPECT_EQ(ended.err, "hydroprint-worker: cancelled\n");
  EXPECT_EQ(names_in(folder.path()), (std::set<std::string>{"progress"}));
}

}  // namespace
}  // namespace hydroprint::fit
