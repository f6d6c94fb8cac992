// Fits of landing points that were computed at a finer resolution.
#include "sim/fit/fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "sim/sample/sample.h"
#include "tests/sim/fit/scene.h"

namespace hydroprint::fit {
namespace {

using testing::ball;
using testing::measured;
using testing::Scene;

film::Profile truth() {
  film::Profile profile;
  profile.ink_ratio_mm = 0.12;
  profile.drag_length_mm = 45;
  profile.swelling = {1.04, 1.02};
  return profile;
}

const Estimate* find(const Outcome& outcome, const std::string& name) {
  const auto found = std::find_if(outcome.estimates.begin(), outcome.estimates.end(),
                                  [&](const Estimate& e) { return e.name == name; });
  return found == outcome.estimates.end() ? nullptr : &*found;
}

std::string reason(const Outcome& outcome, const std::string& name) {
  for (const Undetermined& u : outcome.undetermined) {
    if (u.name == name) return u.reason;
  }
  return {};
}

double value_of(const std::string& name, const film::Profile& profile) {
  if (name == "ink_ratio_mm") return profile.ink_ratio_mm;
  if (name == "drag_length_mm") return profile.drag_length_mm;
  return profile.swelling[name == "swelling_y" ? 1 : 0];
}

void expect_within_intervals(const Outcome& outcome, const film::Profile& wanted) {
  for (const Estimate& e : outcome.estimates) {
    const double value = value_of(e.name, wanted);
    EXPECT_LE(e.low, value) << e.name;
    EXPECT_GE(e.high, value) << e.name;
  }
}

class Ball : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scene = new Scene(ball());
    points = new std::vector<Point>(measured(*scene, truth(), 0.5, 0.1, 1));
  }
  static void TearDownTestSuite() {
    delete scene;
    delete points;
  }
  static Result<Outcome> fitted(const Options& options = {}, const Scene& with = *scene,
                                const std::vector<Point>& of = *points) {
    return fit(with.model, with.dip, of, options, testing::two_threads());
  }

  /// The scene with all parameters known except the swelling, for which `swelling` is assumed.
  static Scene told(const Eigen::Vector2d& swelling) {
    Scene known = *scene;
    known.dip.profile = truth();
    known.dip.profile.swelling = swelling;
    return known;
  }

  static Scene* scene;
  static std::vector<Point>* points;
};

Scene* Ball::scene = nullptr;
std::vector<Point>* Ball::points = nullptr;

TEST_F(Ball, IntervalsContainTheTrueValues) {
  // A fit of all four parameters settles only if the dips are so fine that their numerical scatter
  // does not matter.
  const Scene fine = ball(1.6);
  const auto outcome = fitted({}, fine, measured(fine, truth(), 0.5, 0.1, 1));
  ASSERT_TRUE(outcome) << outcome.error().message;
  ASSERT_EQ(outcome->estimates.size(), 4u);
  EXPECT_TRUE(outcome->settled);
  expect_within_intervals(*outcome, truth());
  // Intervals are useful if they are narrower than the distance between start and true value.
  EXPECT_LT(find(*outcome, "ink_ratio_mm")->high - find(*outcome, "ink_ratio_mm")->low, 0.07);
  EXPECT_LT(find(*outcome, "swelling_x")->standard_error, 0.005);
  EXPECT_LT(find(*outcome, "drag_length_mm")->high, 100);
  EXPECT_LT(outcome->rms_after_mm, 0.2)
      << "the noise is 0.1 mm in each direction, and less on the film where it is stretched";
  EXPECT_GT(outcome->rms_before_mm, 3 * outcome->rms_after_mm);
  EXPECT_FALSE(reason(*outcome, "young_modulus_mpa").empty());
  EXPECT_FALSE(reason(*outcome, "density_kg_per_m3").empty());
  EXPECT_EQ(outcome->profile.young_modulus_mpa, scene->dip.profile.young_modulus_mpa);
}

TEST_F(Ball, WithoutInkTheInkRatioIsNotDetermined) {
  Scene plain = *scene;
  plain.dip.ink = {};
  const auto outcome = fitted({}, plain, measured(plain, truth(), 0.5, 0.1, 2));
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->estimates.size(), 3u);
  EXPECT_NE(reason(*outcome, "ink_ratio_mm").find("--ink-image"), std::string::npos);
  EXPECT_EQ(outcome->profile.ink_ratio_mm, plain.dip.profile.ink_ratio_mm);
  expect_within_intervals(*outcome, truth());
}

TEST_F(Ball, EvenInkDoesNotDetermineTheInkRatio) {
  Scene even = told({1, 1.02});
  even.dip.profile.ink_ratio_mm = film::Profile().ink_ratio_mm;
  even.dip.ink =
      ink::InkField::from_function(ink::ink_grid(even.dip.outline), [](const Eigen::Vector2d&) {
        return 2.0;
      }).value();
  // Fitted without noise, so that noise cannot hide a bias.
  const auto outcome = fitted({{Parameter::kInkRatio, Parameter::kDrag, Parameter::kSwellingX}},
                              even, measured(even, truth(), 1, 0, 2));
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(find(*outcome, "ink_ratio_mm"), nullptr);
  EXPECT_FALSE(reason(*outcome, "ink_ratio_mm").empty());
  EXPECT_NEAR(outcome->profile.swelling.x(), 1.04, 0.002);
}

TEST_F(Ball, ParametersThatAreNotFreeAreHeld) {
  const auto outcome = fitted({{Parameter::kSwellingX, Parameter::kSwellingY}}, told({1, 1}));
  ASSERT_TRUE(outcome) << outcome.error().message;
  ASSERT_EQ(outcome->estimates.size(), 2u);
  EXPECT_EQ(outcome->profile.ink_ratio_mm, 0.12);
  EXPECT_EQ(outcome->profile.drag_length_mm, 45);
  expect_within_intervals(*outcome, truth());
}

TEST_F(Ball, EstimatesAtABoundHaveOneSidedIntervals) {
  const film::Profile none;  // the true values: no drag and no swelling
  const auto outcome = fitted({{Parameter::kDrag, Parameter::kSwellingX, Parameter::kSwellingY}},
                              *scene, measured(*scene, none, 0.5, 0.1, 4));
  ASSERT_TRUE(outcome) << outcome.error().message;
  int at_bound = 0;
  for (const Estimate& e : outcome->estimates) {
    if (e.is_one_sided) ++at_bound;
    if (e.name == "drag_length_mm") {
      EXPECT_TRUE(std::isinf(e.high)) << "the interval must include no drag";
      EXPECT_GT(e.low, 40);
    } else {
      EXPECT_EQ(e.low, 1);
      EXPECT_LT(e.high, 1.02);
    }
  }
  EXPECT_GT(at_bound, 0) << "three true values lie at bounds, so some estimate must, too";
}

TEST_F(Ball, PointsThatCannotCountAreLeftOutWithAReason) {
  std::vector<Point> some = *points;
  some.push_back({{5, 5}, {0, 0, 0}});                  // inside the ball
  some.push_back({{5, 5}, {0, 0, 30}});                 // above the water
  some.push_back({{500, 5}, some.front().surface_mm});  // not on the film
  some.push_back({some.front().film_mm + Eigen::Vector2d(9, 0), some.front().surface_mm});
  Options options{{Parameter::kSwellingX}};
  options.drop_outliers = true;
  const auto outcome = fitted(options, told({1, 1.02}), some);
  ASSERT_TRUE(outcome) << outcome.error().message;
  const auto left_out = [&](std::size_t from_end) {
    return outcome->points[some.size() - from_end].left_out;
  };
  EXPECT_NE(left_out(4).find("1 mm off"), std::string::npos);
  EXPECT_FALSE(left_out(3).empty());
  EXPECT_NE(left_out(2).find("outside the film"), std::string::npos);
  EXPECT_NE(left_out(1).find("outlier"), std::string::npos);
  expect_within_intervals(*outcome, truth());
}

TEST_F(Ball, OutliersCountUnlessTheyAreDropped) {
  std::vector<Point> some = *points;
  some[10].film_mm += Eigen::Vector2d(6, 0);
  const auto outcome = fitted({{Parameter::kInkRatio}}, told(truth().swelling), some);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_TRUE(outcome->points[10].is_used());
  EXPECT_TRUE(outcome->points[10].is_outlier);
  EXPECT_TRUE(std::any_of(outcome->warnings.begin(), outcome->warnings.end(),
                          [](const Warning& w) { return w.code == WarningCode::OUTLIERS; }));
}

TEST_F(Ball, TooFewPointsAndPointsOnOneSpotAreRefused) {
  const std::vector<Point> three(points->begin(), points->begin() + 3);
  const auto few = fitted({}, *scene, three);
  ASSERT_FALSE(few);
  EXPECT_NE(few.error().message.find("3 of 3 can be used"), std::string::npos)
      << few.error().message;
  const auto spot = fitted({}, *scene, std::vector<Point>(100, points->front()));
  ASSERT_FALSE(spot);
  EXPECT_NE(spot.error().message.find("only 1 of them"), std::string::npos) << spot.error().message;
  EXPECT_EQ(exit_status(spot.error()), ExitStatus::kBadInput);
}

TEST_F(Ball, FourPointsCloseTogetherDoNotDetermineADrag) {
  std::vector<Point> close;
  for (const Point& p : *points) {
    if (p.film_mm.norm() < 6) close.push_back(p);
  }
  ASSERT_GE(close.size(), 4u);
  const auto outcome = fitted({{Parameter::kDrag, Parameter::kSwellingX}}, *scene, close);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_FALSE(reason(*outcome, "drag_length_mm").empty());
  EXPECT_EQ(outcome->profile.drag_length_mm, 0);
}

TEST_F(Ball, CancelStopsTheFit) {
  Context context = testing::two_threads();
  int asked = 0;
  context.threads = 1;
  context.cancelled = [&] { return ++asked > 300; };
  const auto outcome = fit(scene->model, scene->dip, *points, {}, context);
  ASSERT_FALSE(outcome);
  EXPECT_EQ(outcome.error().code, Code::kCancelled);
}

TEST(Fit, WarnsWhereTheSheetDoesNotSettle) {
  // Film between two legs that join at the bottom is drawn towards both until it folds.
  Scene bend{sample::make_model("ubend").value(), {}};
  bend.dip.outline = film::parse_outline("A4").value();
  bend.dip = pipeline::scaled_resolution(bend.dip, 3);
  std::vector<Point> feet;
  for (const Eigen::Vector3d& p : bend.model.vertices) {
    if (p.z() > 1 && p.z() < 15) feet.push_back({p.head<2>(), p});
  }
  const Options nothing{{}};  // no parameter to fit, so that one dip is enough
  for (const std::optional<double> depth_mm : {std::optional<double>(), std::optional(20.0)}) {
    bend.dip.depth_mm = depth_mm;
    const auto outcome = fit(bend.model, bend.dip, feet, nothing, testing::two_threads());
    ASSERT_TRUE(outcome) << outcome.error().message;
    const bool warns =
        std::any_of(outcome->warnings.begin(), outcome->warnings.end(),
                    [](const Warning& w) { return w.code == WarningCode::SHEET_UNSETTLED; });
    EXPECT_EQ(warns, !depth_mm.has_value());
  }
}

}  // namespace
}  // namespace hydroprint::fit
