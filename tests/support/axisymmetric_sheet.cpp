#include "tests/support/axisymmetric_sheet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numbers>

// Velocity. With D_rr = u', D_tt = u/r the membrane's tensions are N_rr = 2 h (2u' + u/r) and
// N_tt = 2 h (u' + 2u/r) (over the viscosity), and N_rr' + (N_rr - N_tt)/r = c u with drag c.
// In q = r^2/2 and f = r u, where u' = f_q - f/(2q) and u/r = f/(2q), this becomes
//     4 (h f_q)_q = (h_q / q + c / (2q)) f.
// A uniform film without drag moves with f linear in q.
//
// Dip. Use the wetted area per radian W as time. The waterline's q grows with cos(theta). By
// eq. (1), tan(theta/2) = (1 - cos(theta)) / sin(theta), the film there is drawn inwards with
// f = -(1 - cos(theta)). Sticking does not stretch the film. With Q = q at rest and the area
// stretch J = q_Q, this gives dW = J dQ for the ring Q that is sticking. No term has a pole. A ring
// follows dq/dW = f and keeps its volume, h = h0 / J.
//
// Steps. The independent variable is X, the rest radius of the ring that is sticking. A Runge-Kutta
// step covers two rings, so each of its stages is at a ring, and no ring has to be divided:
//     dW/dX = q_X (at the waterline),   dq/dX = f q_X (at the waterline).

namespace hydroprint::axisymmetric {
namespace {

/// Derivative at the first of five equidistant values, fourth order.
double slope_at_first(std::span<const double> q, double spacing) {
  return (-25 * q[0] + 48 * q[1] - 36 * q[2] + 16 * q[3] - 3 * q[4]) / (12 * spacing);
}
constexpr std::size_t kSlopeRings = 5;

struct State {
  double wetted = 0;
  std::vector<double> q;  ///< q of all rings; those of rings that have stuck are ignored
};

/// Derivative of the state with respect to X.
using Rate = State;

State advanced(const State& from, const Rate& rate, double by, std::size_t first) {
  State to = from;
  to.wetted += by * rate.wetted;
  for (std::size_t j = first; j < to.q.size(); ++j) to.q[j] += by * rate.q[j];
  return to;
}

double angle(const Body& body, double wetted) {
  return std::acos(std::clamp(body.cos_theta(wetted), -1.0, 1.0));
}

class Stepper {
 public:
  Stepper(const Film& film, const Body& body, int rings)
      : film_(film), body_(body), width_(film.vat_mm / rings) {
    if (film.drag_length_mm > 0) {
      drag_ = film.base_thickness_mm / (film.drag_length_mm * film.drag_length_mm);
    }
    for (int j = 0; j <= rings; ++j) state_.q.push_back(j * width_ * j * width_ / 2);
    for (int j = 0; j < rings; ++j) volume_.push_back(volume_from(j * width_));
  }

  std::vector<Landing> run() {
    std::vector<Landing> landings{landing(0)};
    for (std::size_t front = 0; front + 2 + kSlopeRings <= state_.q.size(); front += 2) {
      step(front);
      landings.push_back(landing(front + 2));
      if (state_.wetted >= body_.end_mm2) break;
    }
    return landings;
  }

 private:
  /// Integral of h0 X dX from `x` over one ring's width, by two Gauss points. It is exact for a
  /// uniform film and not affected by a step between rings.
  [[nodiscard]] double volume_from(double x) const {
    const auto density = [&](double at) { return film_.thickness_mm(at) * at; };
    const double middle = x + width_ / 2;
    const double aside = width_ / (2 * std::numbers::sqrt3);
    return width_ / 2 * (density(middle - aside) + density(middle + aside));
  }

  [[nodiscard]] Rate rate(const State& state, std::size_t front) const {
    const auto q = std::span(state.q).subspan(front);
    const double pace = slope_at_first(q, width_);
    const auto drawn =
        flux(q, std::span(volume_).subspan(front), body_.cos_theta(state.wetted) - 1, drag_);
    Rate rate{pace, std::vector<double>(state.q.size())};
    for (std::size_t j = 0; j < drawn.size(); ++j) rate.q[front + j] = drawn[j] * pace;
    return rate;
  }

  /// Classical Runge-Kutta over two rings.
  void step(std::size_t front) {
    const Rate k1 = rate(state_, front);
    const Rate k2 = rate(advanced(state_, k1, width_, front + 1), front + 1);
    const Rate k3 = rate(advanced(state_, k2, width_, front + 1), front + 1);
    const Rate k4 = rate(advanced(state_, k3, 2 * width_, front + 2), front + 2);
    const double sixth = width_ / 3;
    state_ = advanced(state_, k1, sixth, front + 2);
    state_ = advanced(state_, k2, 2 * sixth, front + 2);
    state_ = advanced(state_, k3, 2 * sixth, front + 2);
    state_ = advanced(state_, k4, sixth, front + 2);
  }

  [[nodiscard]] Landing landing(std::size_t front) const {
    const double x = static_cast<double>(front) * width_;
    const double stretch =
        front == 0 ? 1 : slope_at_first(std::span(state_.q).subspan(front), width_) / x;
    return {x,       std::sqrt(2 * state_.q[front]), state_.wetted, angle(body_, state_.wetted),
            stretch, film_.thickness_mm(x) / stretch};
  }

  const Film& film_;
  const Body& body_;
  double width_;
  double drag_ = 0;
  State state_;
  std::vector<double> volume_;  ///< film volume per radian between a ring and the next
};

/// Cubic interpolation of a quantity between two landings, `t` in [0, 1], from its values and its
/// derivatives with respect to X.
double cubic(const Landing& a, const Landing& b, double t, std::array<double, 2> value,
             std::array<double, 2> slope) {
  const double s = 1 - t;
  const double width = b.film_mm - a.film_mm;
  return s * s * ((1 + 2 * t) * value[0] + t * width * slope[0]) +
         t * t * ((1 + 2 * s) * value[1] - s * width * slope[1]);
}

/// Derivative of the wetted area with respect to X.
double slope(const Landing& at) { return at.film_mm * at.area_stretch; }

double wetted_between(const Landing& a, const Landing& b, double t) {
  return cubic(a, b, t, {a.wetted_mm2, b.wetted_mm2}, {slope(a), slope(b)});
}

double waterline_between(const Landing& a, const Landing& b, double t) {
  const auto q = [](const Landing& at) { return at.waterline_mm * at.waterline_mm / 2; };
  const auto q_slope = [](const Landing& at) { return std::cos(at.contact_angle_rad) * slope(at); };
  return std::sqrt(std::max(0.0, 2 * cubic(a, b, t, {q(a), q(b)}, {q_slope(a), q_slope(b)})));
}

}  // namespace

double sphere_wetted_mm2(double radius_mm, double theta_rad) {
  const double half = std::sin(theta_rad / 2);
  return 2 * radius_mm * radius_mm * half * half;
}

Body sphere(double radius_mm, double theta_rad) {
  return {[radius_mm](double wetted) { return 1 - wetted / (radius_mm * radius_mm); },
          sphere_wetted_mm2(radius_mm, theta_rad)};
}

Body cone(double slope_rad, double waterline_mm) {
  const double cos_theta = std::cos(slope_rad);
  return {[cos_theta](double) { return cos_theta; }, waterline_mm * waterline_mm / (2 * cos_theta)};
}

// Linear elements in q with constant thickness in each, so that the term with h_q is the jump of
// the thickness at a ring. The tridiagonal matrix is positive definite.
std::vector<double> flux(std::span<const double> q, std::span<const double> volume,
                         double at_waterline, double drag_per_mm) {
  const std::size_t last = q.size() - 1;
  const auto thickness = [&](std::size_t j) { return volume[j] / (q[j + 1] - q[j]); };
  const auto coupling = [&](std::size_t j) { return 4 * thickness(j) / (q[j + 1] - q[j]); };
  // Elimination from the vat inwards: f[j] = share[j] * f[j - 1].
  std::vector<double> share(q.size(), 0.0);
  for (std::size_t j = last - 1; j > 0; --j) {
    const double outside = coupling(j);
    const double inside = coupling(j - 1);
    const double own =
        (thickness(j) - thickness(j - 1)) / q[j] + drag_per_mm * (q[j + 1] - q[j - 1]) / (4 * q[j]);
    share[j] = inside / (inside + outside * (1 - share[j + 1]) + own);
  }
  std::vector<double> f(q.size(), at_waterline);
  for (std::size_t j = 1; j <= last; ++j) f[j] = share[j] * f[j - 1];
  return f;
}

Dip::Dip(const Film& film, const Body& body, int rings)
    : film_(film), body_(body), landings_(Stepper(film_, body_, rings).run()) {}

std::optional<Landing> Dip::at_film(double film_mm) const {
  const auto after =
      std::upper_bound(landings_.begin(), landings_.end(), film_mm,
                       [](double film, const Landing& landing) { return film < landing.film_mm; });
  if (after == landings_.begin() || after == landings_.end()) return std::nullopt;
  const Landing& a = *std::prev(after);
  const Landing& b = *after;
  const double t = (film_mm - a.film_mm) / (b.film_mm - a.film_mm);
  const double wetted = wetted_between(a, b, t);
  const double stretch = std::lerp(a.area_stretch, b.area_stretch, t);
  return Landing{film_mm, waterline_between(a, b, t),           wetted, angle(body_, wetted),
                 stretch, film_.thickness_mm(film_mm) / stretch};
}

std::optional<Landing> Dip::at_wetted(double wetted_mm2) const {
  double low = 0;
  double high = landings_.back().film_mm;
  if (wetted_mm2 < 0 || wetted_mm2 >= landings_.back().wetted_mm2) return std::nullopt;
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = (low + high) / 2;
    (at_film(middle)->wetted_mm2 < wetted_mm2 ? low : high) = middle;
  }
  return at_film(low);
}

}  // namespace hydroprint::axisymmetric
