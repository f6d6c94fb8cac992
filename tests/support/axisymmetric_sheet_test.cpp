#include "tests/support/axisymmetric_sheet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

#include "tests/support/exact_sphere.h"

namespace hydroprint::axisymmetric {
namespace {

constexpr double kSphere = 40;
constexpr double kVat = 105;
constexpr double kThickness = 0.5;

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

Film uniform_film() {
  return {kVat, [](double) { return kThickness; }, kThickness};
}

/// A twice differentiable step: 0 below -0.5, 1 above 0.5.
double rise(double x) {
  const double t = std::clamp(x + 0.5, 0.0, 1.0);
  return t * t * t * (10 + t * (-15 + 6 * t));
}

/// A ring of two full inks from 30 to 45 mm with edges 1 mm wide.
Film ringed_film(double drag_length_mm) {
  return {kVat, [](double x) { return kThickness + 0.1 * (rise(x - 30) - rise(x - 45)); },
          kThickness, drag_length_mm};
}

Dip sphere_dip(const Film& film, double degrees, int rings) {
  return {film, sphere(kSphere, radians(degrees)), rings};
}

Landing landing_on_sphere(const Dip& dip, double degrees) {
  return dip.at_wetted(sphere_wetted_mm2(kSphere, radians(degrees))).value();
}

TEST(AxisymmetricSheet, UniformFilmFollowsTheExactMapOfTheSphere) {
  const Dip dip = sphere_dip(uniform_film(), 160, 500);
  for (int degrees = 1; degrees <= 160; ++degrees) {
    EXPECT_NEAR(landing_on_sphere(dip, degrees).film_mm,
                exact::film_radius_mm(kSphere, kVat, radians(degrees)), 1e-6)
        << degrees;
  }
  for (int film_mm = 1; film_mm < 70; ++film_mm) {
    EXPECT_NEAR(dip.at_film(film_mm)->contact_angle_rad,
                exact::contact_angle_rad(kSphere, kVat, film_mm), 1e-7)
        << film_mm;
  }
}

TEST(AxisymmetricSheet, UniformFilmGivesTheTableOfTheFieldNotes) {
  constexpr std::array<std::pair<double, double>, 8> table{{{10, 6.97242041},
                                                            {30, 20.69636813},
                                                            {60, 39.74423988},
                                                            {90, 55.09681288},
                                                            {110, 62.49930249},
                                                            {120, 65.32423024},
                                                            {135, 68.5571922},
                                                            {150, 70.72089069}}};
  const Dip dip = sphere_dip(uniform_film(), 150, 1000);
  for (const auto& [degrees, film_mm] : table) {
    EXPECT_NEAR(landing_on_sphere(dip, degrees).film_mm, film_mm, 2e-8);
  }
}

TEST(AxisymmetricSheet, UniformFilmIsDilutedAsInTheExactSolution) {
  const Dip dip = sphere_dip(uniform_film(), 150, 4200);
  const double k2 = kVat * kVat / (kSphere * kSphere) - 1;
  const double k = std::sqrt(k2);
  for (int degrees = 10; degrees <= 150; degrees += 10) {
    const double c = std::cos(radians(degrees));
    const double stretch =
        (k2 + c * c) / (k2 + 1) * std::exp(2 / k * (std::atan(1 / k) - std::atan(c / k)));
    const Landing landing = landing_on_sphere(dip, degrees);
    EXPECT_NEAR(landing.area_stretch, stretch, 1e-5);
    EXPECT_NEAR(landing.thickness_mm, kThickness / stretch, 1e-5);
  }
}

TEST(AxisymmetricSheet, UniformFilmFollowsTheExactMapOfACone) {
  const double slope = radians(50);
  const Dip dip(uniform_film(), cone(slope, 60), 500);
  for (int waterline = 1; waterline < 60; ++waterline) {
    const double share = waterline / kVat;
    const double exact = kVat * std::sqrt(1 - std::pow(1 - share * share, 1 / std::cos(slope)));
    const auto landing = dip.at_wetted(waterline * waterline / (2 * std::cos(slope)));
    EXPECT_NEAR(landing->film_mm, exact, 1e-6);
    EXPECT_NEAR(landing->waterline_mm, waterline, 1e-5);
  }
}

TEST(AxisymmetricSheet, ThereIsNoLandingPastTheEndOfTheDip) {
  const Dip dip = sphere_dip(uniform_film(), 90, 500);
  EXPECT_TRUE(dip.at_film(55));
  EXPECT_FALSE(dip.at_film(56));
  EXPECT_FALSE(dip.at_wetted(sphere_wetted_mm2(kSphere, radians(92))));
}

/// Largest difference between flux() and the exact velocity `u`, between the radii 20 mm and
/// `kVat`.
double flux_error(int rings, double drag_per_mm, const std::function<double(double)>& thickness,
                  const std::function<double(double)>& u) {
  const double width = (kVat - 20) / rings;
  std::vector<double> q;
  std::vector<double> volume;
  q.reserve(rings + 1);
  volume.reserve(rings);
  for (int j = 0; j <= rings; ++j) q.push_back(std::pow(20 + j * width, 2) / 2);
  for (int j = 0; j < rings; ++j) {
    volume.push_back(thickness(20 + (j + 0.5) * width) * (q[j + 1] - q[j]));
  }
  const auto f = flux(q, volume, 20 * u(20), drag_per_mm);
  double most = 0;
  for (int j = 0; j <= rings; ++j) {
    const double r = std::sqrt(2 * q[j]);
    most = std::max(most, std::abs(f[j] / r - u(r)));
  }
  return most;
}

double order(double coarse, double fine) { return std::log2(coarse / fine); }

// The equation is 4 (u'' + u'/r - u/r^2) = u / L^2, so the length in the Bessel functions is 2 L.
TEST(AxisymmetricSheet, DragOnAUniformFilmGivesBesselFunctions) {
  const double drag_length = 8;
  const auto first = [&](double r) { return std::cyl_bessel_i(1, r / (2 * drag_length)); };
  const auto second = [&](double r) { return std::cyl_bessel_k(1, r / (2 * drag_length)); };
  const auto u = [&](double r) { return second(r) * first(kVat) - first(r) * second(kVat); };
  const auto thickness = [](double) { return kThickness; };
  const double drag = kThickness / (drag_length * drag_length);
  const double fine = flux_error(2000, drag, thickness, u);
  EXPECT_LT(fine, 1e-5 * u(20));
  EXPECT_NEAR(order(flux_error(1000, drag, thickness, u), fine), 2, 0.1);
}

// Where h = r^m, u = r^s balances N_rr' + (N_rr - N_tt)/r if (m + s - 1)(2s + 1) + s - 1 = 0.
TEST(AxisymmetricSheet, ThicknessThatIsAPowerOfTheRadiusGivesPowers) {
  for (const double m : {-1.5, 1.0, 3.0}) {
    const double root = std::sqrt(m * m - 2 * m + 4);
    const double rising = (-m + root) / 2;
    const double falling = (-m - root) / 2;
    for (const double s : {rising, falling}) {
      ASSERT_NEAR((m + s - 1) * (2 * s + 1) + s - 1, 0, 1e-12);
    }
    const double mix = std::pow(kVat, falling - rising);  // so that the film is at rest at the vat
    const auto u = [&](double r) { return std::pow(r, falling) - mix * std::pow(r, rising); };
    const auto thickness = [&](double r) { return std::pow(r, m); };
    const double fine = flux_error(2000, 0, thickness, u);
    EXPECT_LT(fine, 1e-5 * std::abs(u(20)));
    EXPECT_NEAR(order(flux_error(1000, 0, thickness, u), fine), 2, 0.1);
  }
}

// A film of two thicknesses: in each part u = A r + B / r, which keeps each part uniform. The whole
// dip is then an ordinary differential equation for the seam's radius and the consumed film.
class TwoParts {
 public:
  TwoParts(double inner_mm, double outer_mm, double seam_mm)
      : inner_(inner_mm), outer_(outer_mm), rest_(seam_mm), now_{seam_mm, 0} {}

  /// Film radius that lands at `degrees`, by Runge-Kutta steps in the contact angle.
  double film_at(double degrees) {
    const int steps = 2000;
    const double step = radians(degrees) / steps;
    for (int i = 0; i < steps; ++i) {
      const double at = i * step;
      const Pair k1 = rate(at, now_);
      const Pair k2 = rate(at + step / 2, moved(k1, step / 2));
      const Pair k3 = rate(at + step / 2, moved(k2, step / 2));
      const Pair k4 = rate(at + step, moved(k3, step));
      for (int n : {0, 1}) now_[n] += step / 6 * (k1[n] + 2 * k2[n] + 2 * k3[n] + k4[n]);
    }
    return std::sqrt(now_[1]);
  }

 private:
  /// Radius of the seam, and square of the consumed film's radius.
  using Pair = std::array<double, 2>;

  [[nodiscard]] Pair moved(const Pair& rate, double by) const {
    return {now_[0] + by * rate[0], now_[1] + by * rate[1]};
  }

  [[nodiscard]] Pair rate(double theta, const Pair& state) const {
    const double a = kSphere * std::sin(theta);
    // Pull per unit of angle: -tan(theta/2) ds.
    const double pull = -kSphere * (1 - std::cos(theta));
    const double seam = state[0];
    const double inner_stretch = (seam * seam - a * a) / (rest_ * rest_ - state[1]);
    const double outer_stretch = (kVat * kVat - seam * seam) / (kVat * kVat - rest_ * rest_);
    // A and B of the part between radii r1 and r2, which move at u1 and u2.
    const auto between = [](double r1, double u1, double r2, double u2) {
      const double slope = (u2 * r2 - u1 * r1) / (r2 * r2 - r1 * r1);
      return Pair{slope, u1 * r1 - slope * r1 * r1};
    };
    // N_rr = 2 h (3 A - B / r^2) at the seam, inside minus outside. It is linear in the seam's
    // velocity.
    const auto imbalance = [&](double u) {
      const auto [a1, b1] = between(a, pull, seam, u);
      const auto [a2, b2] = between(seam, u, kVat, 0);
      return inner_ / inner_stretch * (3 * a1 - b1 / (seam * seam)) -
             outer_ / outer_stretch * (3 * a2 - b2 / (seam * seam));
    };
    const double still = imbalance(0);
    const double u = still / (still - imbalance(1));
    // Per angle and radian, the wetted area grows by R^2 sin(theta), and the squared radius of the
    // consumed film by twice that area at rest.
    return {u, 2 * kSphere * kSphere * std::sin(theta) / inner_stretch};
  }

  double inner_;
  double outer_;
  double rest_;
  Pair now_;
};

TEST(AxisymmetricSheet, FilmOfTwoThicknessesFollowsItsDifferentialEquation) {
  for (const auto& [inner, outer] : {std::pair(0.5, 0.7), std::pair(0.7, 0.5)}) {
    const auto thickness = [inner = inner, outer = outer](double x) {
      return x < 63 ? inner : outer;
    };
    const Dip dip = sphere_dip({kVat, thickness, kThickness}, 100, 1050);
    for (const double degrees : {20.0, 50.0, 75.0, 100.0}) {
      EXPECT_NEAR(landing_on_sphere(dip, degrees).film_mm,
                  TwoParts(inner, outer, 63).film_at(degrees), 1e-6)
          << degrees;
    }
    EXPECT_GT(std::abs(landing_on_sphere(dip, 100).film_mm -
                       exact::film_radius_mm(kSphere, kVat, radians(100))),
              0.5);
  }
}

/// Film radii that land at 10, 20, ... 120 degrees.
std::vector<double> film_radii(const Film& film, int rings) {
  const Dip dip = sphere_dip(film, 120, rings);
  std::vector<double> radii;
  for (int degrees = 10; degrees <= 120; degrees += 10) {
    radii.push_back(landing_on_sphere(dip, degrees).film_mm);
  }
  return radii;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

// The edges of the ink ring must be much wider than the rings of film. Otherwise the fourth-order
// part of the error dominates.
TEST(AxisymmetricSheet, MapAroundAnInkRingIsOfSecondOrderOrBetter) {
  for (const double drag_length : {0.0, 20.0}) {
    const Film film = ringed_film(drag_length);
    const auto coarse = film_radii(film, 1050);
    const auto middle = film_radii(film, 2100);
    const auto fine = film_radii(film, 4200);
    EXPECT_LT(largest_difference(middle, fine), 1e-5);
    EXPECT_GT(order(largest_difference(coarse, middle), largest_difference(middle, fine)), 1.9);
  }
}

TEST(AxisymmetricSheet, RingsStickAtTheWaterline) {
  for (const double drag_length : {0.0, 20.0}) {
    const Dip dip = sphere_dip(ringed_film(drag_length), 120, 4200);
    for (const Landing& landing : dip.landings()) {
      ASSERT_NEAR(landing.waterline_mm, kSphere * std::sin(landing.contact_angle_rad), 1e-5);
    }
  }
}

TEST(AxisymmetricSheet, InkedFilmIsStretchedLessAndItsNeighboursMore) {
  const Dip uniform = sphere_dip(uniform_film(), 120, 1050);
  const Dip ringed = sphere_dip(ringed_film(0), 120, 1050);
  const auto excess = [&](double film_mm) {
    return ringed.at_film(film_mm)->area_stretch - uniform.at_film(film_mm)->area_stretch;
  };
  EXPECT_GT(excess(29), 0);
  EXPECT_LT(excess(38), 0);
  EXPECT_GT(excess(46), 0);
}

TEST(AxisymmetricSheet, OnlyRelativeThicknessMatters) {
  const Film thin = ringed_film(20);
  const Film thick{kVat, [&](double x) { return 3 * thin.thickness_mm(x); }, 3 * kThickness, 20};
  EXPECT_LT(largest_difference(film_radii(thin, 500), film_radii(thick, 500)), 1e-10);
}

// The volume is computed from the wetted area where the film lands, and from its area at rest.
TEST(AxisymmetricSheet, DepositedVolumeEqualsConsumedVolume) {
  const Film film = ringed_film(20);
  const Dip dip = sphere_dip(film, 150, 4200);
  double deposit = 0;
  double taken = 0;
  for (std::size_t i = 1; i < dip.landings().size(); ++i) {
    const Landing& a = dip.landings()[i - 1];
    const Landing& b = dip.landings()[i];
    deposit += (a.thickness_mm + b.thickness_mm) / 2 * (b.wetted_mm2 - a.wetted_mm2);
    taken += (film.thickness_mm(a.film_mm) + film.thickness_mm(b.film_mm)) / 4 *
             (b.film_mm * b.film_mm - a.film_mm * a.film_mm);
  }
  EXPECT_NEAR(deposit / taken, 1, 1e-6);
}

}  // namespace
}  // namespace hydroprint::axisymmetric
