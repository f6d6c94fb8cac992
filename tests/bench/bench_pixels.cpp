// Compares the fast pixel map (the tiles of the film image) with one particle per pixel. See
// README.md.
//
// Usage: bench_pixels BODY PIXELS
#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <string>
#include <utility>

#include "sim/pipeline/stokes_pass.h"
#include "sim/sample/icosphere.h"
#include "sim/sample/sample.h"
#include "tests/bench/figures.h"
#include "tests/sim/flow/pixels.h"

namespace hydroprint::bench {
namespace {

using flow::reference::Pixel;
using flow::reference::PixelComparison;
using flow::reference::PixelError;
using flow::reference::PixelMap;

constexpr double kDpi = 600;
constexpr double kTolerance_mm = 0.04;  ///< allowed error of the map, on the film
constexpr double kStep_mm = 0.1;        ///< depth of one step of the particles
constexpr double kSettled_mm = 0.01;    ///< allowed change on the film when kStep_mm is halved
constexpr unsigned kSeed = 5;
constexpr int kMostTries = 50'000'000;  ///< random pixels tried to find those at jumps

struct Body {
  mesh::Model model;
  pipeline::DipOptions options;
};

/// Returns the pose in which the model is rotated about the x axis and its bounding box is centred
/// on the film.
Pose tilted(const mesh::Model& model, double angle_rad) {
  Pose X_FO(Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitX()));
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : model.vertices) box.extend(X_FO * p);
  X_FO.pretranslate(-box.center());
  return X_FO;
}

/// Returns the off-centre sphere, or a sample on A4; the board is tilted by 30 degrees.
Body body_named(const std::string& name) {
  Body body;
  if (name == "sphere") {
    body.model = sample::icosphere(testing::kOffCentreRadius_mm, 6);
    body.options = testing::off_centre_options(pipeline::FilmModel::kSheet);
  } else {
    body.model = value_of(sample::make_model(name));
    body.options.outline = value_of(film::parse_outline("A4"));
    if (name == "board") body.options.X_FO = tilted(body.model, std::numbers::pi / 6);
  }
  body.options.map.make_tiles = true;
  return body;
}

flow::DipField sheet_of(const pipeline::StokesPass& start, const pipeline::DipOptions& options) {
  return value_of(pipeline::sheet_field(start.stokes, {}, options, two_threads())).field;
}

/// Runs work(i) on all cores.
template <class Work>
void for_each(std::size_t count, Work&& work) {
  const Status done = parallel_for(two_threads(), {}, count, [&](std::size_t i) -> Status {
    work(i);
    return {};
  });
  if (!done) give_up(done.error());
}

/// The pixel map of a dip at the default settings, and a reference dip for its particles.
class Trial {
 public:
  explicit Trial(const Body& body)
      : start_(value_of(pipeline::run_stokes_pass(body.model, body.options, two_threads()))),
        field_(sheet_of(start_, body.options)),
        fast_(value_of(pipeline::trace_flow_map(start_, field_, body.options, two_threads()))),
        map_(start_.body, fast_.tiles, image::film_grid(body.options.outline, 25.4 / kDpi)),
        reference_(reference_of(body)),
        particles_(start_.body, reference_, kStep_mm),
        finer_(start_.body, reference_, kStep_mm / 2),
        comparison_(map_, start_.body, particles_) {}

  /// Compares map and particles at random pixels at which one of them lands.
  Json pixels(int count) const {
    std::mt19937 random(kSeed);
    std::vector<Pixel> chosen;
    for (int i = 0; i < count; ++i) chosen.push_back(any_pixel(random));
    std::vector<PixelError> errors(chosen.size());
    std::vector<double> moved_mm(chosen.size());
    for_each(chosen.size(), [&](std::size_t i) {
      errors[i] = comparison_.at(chosen[i]);
      moved_mm[i] = comparison_.moved_mm(chosen[i], finer_);
    });
    std::size_t landed = 0, within = 0, ruled = 0, one_sided = 0, settled = 0;
    for (std::size_t i = 0; i < errors.size(); ++i) {
      const PixelError& error = errors[i];
      ruled += error.is_ruled;
      if (!error.lands || error.is_ruled) continue;
      ++landed;
      within += error.error_mm <= kTolerance_mm;
      one_sided += std::isinf(error.error_mm);
      settled += moved_mm[i] <= kSettled_mm;
    }
    report_worst(chosen, errors);
    const auto share = [&](std::size_t n) {
      return static_cast<double>(n) / static_cast<double>(landed);
    };
    return {{"share_within", share(within)},
            {"pixels", landed},
            {"share_of_one_only", share(one_sided)},
            {"share_of_particles_settled", share(settled)},
            {"not_counted_by_rule", ruled}};
  }

  /// Measures the errors in the positions of jumps, at random pixels where the map jumps.
  Json jumps(int count) const {
    std::mt19937 random(kSeed);
    std::vector<Pixel> chosen;
    for (int tries = 0; tries < kMostTries && std::ssize(chosen) < count; ++tries) {
      const Pixel pixel = any_pixel(random);
      if (map_.is_at_jump(pixel)) chosen.push_back(pixel);
    }
    std::vector<double> distances(chosen.size());
    for_each(chosen.size(), [&](std::size_t i) {
      const Pixel next =
          (chosen[i] + Pixel(1, 1)).cwiseMin(Pixel(map_.grid().columns - 1, map_.grid().rows - 1));
      for (const Pixel& p :
           {chosen[i], Pixel(next.x(), chosen[i].y()), Pixel(chosen[i].x(), next.y())}) {
        distances[i] = std::max(distances[i], comparison_.jump_distance_mm(p));
      }
    });
    std::size_t within = 0;
    double most = 0;
    for (std::size_t i = 0; i < distances.size(); ++i) {
      within += distances[i] <= map_.grid().pitch_mm;
      most = std::max(most, distances[i]);
      if (distances[i] > map_.grid().pitch_mm) {
        const auto film = map_.film_mm(chosen[i]);
        std::fprintf(stderr, "jump misplaced by %.3f mm at film point (%.2f, %.2f) mm\n",
                     distances[i], film.x(), film.y());
      }
    }
    return {
        {"jump_pixels", distances.size()},
        {"jump_share_within", static_cast<double>(within) /
                                  static_cast<double>(std::max<std::size_t>(distances.size(), 1))},
        {"jump_most_mm", most}};
  }

 private:
  /// The dip of the same body and film with smaller steps between waterlines. Particles need these
  /// because they interpolate velocities linearly between waterlines.
  static flow::DipField reference_of(const Body& body) {
    pipeline::DipOptions close = body.options;
    close.schedule.swept_mm /= 4;
    const pipeline::StokesPass start =
        value_of(pipeline::run_stokes_pass(body.model, close, two_threads()));
    return sheet_of(start, close);
  }

  Pixel any_pixel(std::mt19937& random) const {
    return {static_cast<int>(random() % static_cast<unsigned>(map_.grid().columns)),
            static_cast<int>(random() % static_cast<unsigned>(map_.grid().rows))};
  }

  void report_worst(const std::vector<Pixel>& pixels, const std::vector<PixelError>& errors) const {
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      if (errors[i].is_ruled || errors[i].error_mm <= kTolerance_mm) continue;
      const auto film = map_.film_mm(pixels[i]);
      const auto spot = map_.at(pixels[i]);
      const Eigen::Vector3d at = spot ? spot->point_mm : Eigen::Vector3d::Constant(std::nan(""));
      std::fprintf(
          stderr,
          "film point (%.2f, %.2f) mm: error %.3f mm; the map lands at (%.2f, %.2f, %.2f) mm\n",
          film.x(), film.y(), errors[i].error_mm, at.x(), at.y(), at.z());
    }
  }

  pipeline::StokesPass start_;
  flow::DipField field_;
  flow::FlowMap fast_;
  PixelMap map_;
  flow::DipField reference_;
  flow::reference::Particles particles_, finer_;
  PixelComparison comparison_;
};

}  // namespace
}  // namespace hydroprint::bench

int main(int argc, char** argv) {
  using namespace hydroprint;
  if (argc != 3) {
    std::fputs("usage: bench_pixels sphere|mug|ubend|board|... PIXELS\n", stderr);
    return 2;
  }
  const std::string name = argv[1];
  const int count = std::stoi(argv[2]);
  const bench::Trial trial(bench::body_named(name));
  bench::Json figures = trial.pixels(count);
  figures.update(trial.jumps(count / 50));
  bench::print("pixels-" + name, figures);
}
