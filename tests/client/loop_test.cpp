// The random draws and the evaluation of `hydroprint loop`.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "client/loop/draws.h"
#include "client/loop/measure.h"
#include "client/loop/report.h"
#include "client/loop/surface_map.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::loop {
namespace {

/// A flat face. Each of its points gets film from directly below it, shifted by `off`.
SurfaceMap flat(const Eigen::Vector2d& off) {
  constexpr int kSide = 13;
  SurfaceMap out;
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      out.points.emplace_back(10 * i, 10 * j, 0);
      out.film_mm.emplace_back(10 * i - 60 + off.x(), 10 * j - 60 + off.y());
      out.time_s.push_back(1);
      if (i == 0 || j == 0) continue;
      const int c = j * kSide + i;
      out.triangles.emplace_back(c - kSide - 1, c - kSide, c);
      out.triangles.emplace_back(c - kSide - 1, c, c - 1);
    }
  }
  return out;
}

const Body kBoard{"board", Eigen::Matrix3d::Identity(), false, {}};

double largest(const CrossErrors& errors) { return quantile(lengths_mm(errors), 1); }

TEST(Loop, ErrorsAreTheDisplacementsOfCrossPoints) {
  const SurfaceMap plan = flat({0, 0});
  const Truth well;
  EXPECT_EQ(cross_errors(kBoard, plan, plan, well).size(), 169U);
  EXPECT_NEAR(largest(cross_errors(kBoard, plan, plan, well)), 0, 1e-12);
  const CrossErrors aside = cross_errors(kBoard, plan, flat({0.3, -0.4}), well);
  EXPECT_NEAR(quantile(lengths_mm(aside), 0.5), 0.5, 1e-9);
  EXPECT_EQ(lost(aside), 25) << "the points at two edges miss the face";
  Truth off;
  off.printer_scale = 0.999;
  EXPECT_NEAR(largest(cross_errors(kBoard, plan, plan, off)), 0.001 * std::hypot(60, 60), 1e-9);
  off = {};
  off.film_mm = {0.3, -0.4};
  EXPECT_NEAR(largest(cross_errors(kBoard, plan, flat({0.3, -0.4}), off)), 0, 1e-9)
      << "equal errors cancel";
}

TEST(Loop, FilmStaysOnTheTriangleItReachesFirst) {
  SurfaceMap map;
  for (const double height_mm : {5.0, 0.0}) {
    for (const auto& at : {Eigen::Vector2d(0, 0), Eigen::Vector2d(9, 0), Eigen::Vector2d(0, 9)}) {
      map.points.emplace_back(at.x(), at.y(), height_mm);
      map.film_mm.push_back(at);
      map.time_s.push_back(1 + height_mm);
    }
  }
  map.triangles = {{0, 1, 2}, {3, 4, 5}};
  const FilmLocator locator(map);
  EXPECT_NEAR((*locator.at({2, 3}) - Eigen::Vector3d(2, 3, 0)).norm(), 0, 1e-12);
  EXPECT_FALSE(locator.at({6, 6}));
  map.film_mm[3] = {NAN, NAN};
  EXPECT_EQ(FilmLocator(map).at({2, 3})->z(), 5) << "points without film are not found";
}

TEST(Loop, DrawsAreWithinTheirBoundsAndReproducible) {
  for (const char* name : {"board", "sphere80"}) {
    const Body body = make_body(name).value();
    const Pose nominal = nominal_pose(body);
    for (int i = 0; i < 200; ++i) {
      const Truth truth = draw(body, 1, i);
      const Eigen::Matrix3d off = truth.X_GO.linear() * nominal.linear().transpose();
      EXPECT_LE(Eigen::AngleAxisd(off).angle(), kMostTilt_deg * kDegree + 1e-9);
      EXPECT_LE(std::atan(truth.slope.norm()), kMostSlope_deg * kDegree + 1e-9);
      EXPECT_LE(truth.film_mm.norm(), kMostFilm_mm + 1e-9);
      EXPECT_LE(std::abs(truth.printer_scale - 1), kMostScale);
      if (body.is_round) {
        EXPECT_TRUE(off.isIdentity(1e-9)) << "a scan cannot measure the rotation of a round body";
      }
      EXPECT_NEAR(height_mm(body, truth, 300) - height_mm(body, truth, 200), 100, 1e-9);
      const Pose there = pose_at_contact(body, truth, 200);
      double lowest_mm = 1e9;
      for (const auto& p : body.points) lowest_mm = std::min(lowest_mm, (there * p).z());
      EXPECT_NEAR(lowest_mm, 0, 1e-9);
    }
    EXPECT_TRUE(draw(body, 1, 3).X_GO.isApprox(draw(body, 1, 3).X_GO, 0));
    EXPECT_FALSE(draw(body, 1, 3).X_GO.isApprox(draw(body, 2, 3).X_GO));
  }
  EXPECT_EQ(make_body("mug").error().code, Code::kInvalidArgument);
}

TEST(Loop, InvalidSurfaceMapsAreRefused) {
  const testing::TemporaryFolder folder;
  const auto refused = [&](const std::string& text) {
    const auto map = read_surface_map(folder.write("map.ply", text));
    return !map && map.error().code == Code::kInvalidArgument;
  };
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty double x\n"
      "property double y\nproperty double z\nproperty double film_x\nproperty double film_y\n"
      "property double contact_time\nproperty double stretch\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n";
  const std::string points(3 * 7 * 8, '\0');
  EXPECT_TRUE(refused(""));
  EXPECT_TRUE(refused(header));
  EXPECT_TRUE(refused(header + points));
  EXPECT_TRUE(refused(header + points + std::string("\3\0\0\0\0\1\0\0\0\7\0\0\0", 13)));
  const std::string triangle("\3\0\0\0\0\1\0\0\0\2\0\0\0", 13);
  EXPECT_FALSE(refused(header + points + triangle));
  std::string later = header;
  later.insert(later.find("element face"), "property double error_mm\n");
  EXPECT_TRUE(refused(later + points + triangle)) << "too short";
  EXPECT_FALSE(refused(later + points + std::string(3 * 8, '\0') + triangle));
  std::string flagged = header;
  flagged.insert(flagged.find("end_header"), "property uchar flags\n");
  EXPECT_TRUE(refused(flagged + points + triangle)) << "too short";
  EXPECT_FALSE(refused(flagged + points + triangle + '\x09'));
}

TEST(Loop, TheBoardIsFullyInViewOfTheCamera) {
  const std::string obj = board_obj();
  std::istringstream lines(obj);
  std::vector<Eigen::Vector3d> points;
  for (std::string line; std::getline(lines, line) && line.starts_with("v ");) {
    std::istringstream words(line.substr(2));
    Eigen::Vector3d p;
    words >> p.x() >> p.y() >> p.z();
    points.push_back(p);
  }
  ASSERT_GT(points.size(), 50U);
  EXPECT_NE(obj.find("\nf 1 2 3\n"), std::string::npos);
  constexpr double kFocal_px = 580;
  for (int i = 0; i < 12; ++i) {
    const Pose X_CB = held_board(1, i);
    EXPECT_GT(-(X_CB.linear() * Eigen::Vector3d::UnitZ()).z(), 0.8) << "the board faces the camera";
    for (const Eigen::Vector3d& p : points) {
      const Eigen::Vector3d seen = X_CB * p;
      EXPECT_LT(std::abs(seen.x() / seen.z()), 320 / kFocal_px) << i;
      EXPECT_LT(std::abs(seen.y() / seen.z()), 240 / kFocal_px) << i;
    }
  }
  EXPECT_FALSE(held_board(1, 3).isApprox(held_board(2, 3)));
}

TEST(Loop, TheReportShowsTheErrorItsSourcesAndItsLimits) {
  const auto errors = [](double x, double y) { return CrossErrors{{x, 0, 0}, {0, y, 0}}; };
  Round round;
  round.numerics = errors(0.1, 0.2);
  round.calibration = errors(0.3, 0.4);
  round.motion = errors(0.2, 0.6);
  round.placement = errors(0.7, 1.4);
  round.pictures = {"a.png"};
  const Report of{"board", 1.0, 7, "calibrations/2", {round}};
  const auto report = nlohmann::json::parse(report_json(of));
  EXPECT_EQ(report["errors"]["placement"]["p95_mm"], 1.4);
  EXPECT_EQ(report["passed"], false);
  ASSERT_FALSE(verdict(of));
  EXPECT_EQ(exit_status(verdict(of).error()), ExitStatus::kFailed);
  EXPECT_NE(verdict(of).error().message.find("within 1.40 mm (limit: "), std::string::npos)
      << verdict(of).error().message;
  EXPECT_EQ(report["errors"]["numerics"]["max_mm"], 0.2);
  EXPECT_EQ(report["rounds"][0]["truth"]["printer_scale"], 1);
  double sum = 0;
  for (const auto& stage : report["errors"]) sum += stage["share"].get<double>();
  EXPECT_NEAR(sum, 1, 1e-12);
  EXPECT_NEAR(report["errors"]["motion"]["share"],
              (-0.1 * 0.7 + 0.2 * 1.4) / (0.7 * 0.7 + 1.4 * 1.4), 1e-12);
  const std::string page = report_html(of);
  for (const char* words : {"1.40 mm", "limit: 1.00 mm", "Not covered", "src=\"a.png\""})
    EXPECT_NE(page.find(words), std::string::npos) << words;
  EXPECT_NE(report_text(of).find("within 1.40 mm"), std::string::npos) << report_text(of);
}

TEST(Loop, LostCrossPointsAreCountedAndDoNotAffectShares) {
  Round round;
  round.numerics = round.calibration = round.motion = {{1, 0, 0}, {1, 0, 0}};
  round.placement = {{2, 0, 0}, Eigen::Vector3d::Constant(NAN)};
  const auto report = nlohmann::json::parse(report_json({"board", 3, 7, "", {round}}));
  EXPECT_EQ(report["lost_cross_points"], 1);
  EXPECT_EQ(report["passed"], false);
  EXPECT_EQ(report["errors"]["placement"]["share"], 0.5);
}

}  // namespace
}  // namespace hydroprint::loop
