// Compares dips of eight bodies with references in fine settings, which are data of this folder.
// See README.md.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "sim/mesh/read/read_model.h"
#include "sim/pipeline/dip.h"
#include "tests/bench/figures.h"

namespace hydroprint::bench {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using pipeline::DipOptions;
using pipeline::FilmModel;

/// Values along one side of a rounded box: flat in the middle, and closer on the round edges.
std::vector<double> ticks(double core_mm, double radius_mm, double step_mm) {
  constexpr int kRound = 6;
  const int flat = std::max(1, static_cast<int>(std::ceil(2 * core_mm / step_mm)));
  std::vector<double> out;
  for (int i = kRound; i > 0; --i)
    out.push_back(-core_mm - radius_mm * std::tan(std::numbers::pi / 4 * i / kRound));
  for (int i = 0; i <= flat; ++i) out.push_back(-core_mm + 2 * core_mm * i / flat);
  for (int i = 1; i <= kRound; ++i)
    out.push_back(core_mm + radius_mm * std::tan(std::numbers::pi / 4 * i / kRound));
  return out;
}

/// A closed box with rounded edges, from a grid on a cube that is moved onto it.
class RoundedBox {
 public:
  RoundedBox(const Vector3d& size_mm, double radius_mm)
      : half_mm_(0.5 * size_mm), core_mm_(half_mm_.array() - radius_mm), radius_mm_(radius_mm) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {-1.0, 1.0}) add_face(axis, side);
    }
  }
  mesh::Model model;

 private:
  int vertex(const Vector3d& q) {
    std::array<long, 3> key{};
    for (int i = 0; i < 3; ++i) key[i] = std::lround(1e4 * q[i]);
    const auto [it, is_new] = index_.try_emplace(key, static_cast<int>(model.vertices.size()));
    if (is_new) {
      const Vector3d c = q.cwiseMax(-core_mm_).cwiseMin(core_mm_);
      model.vertices.emplace_back(c + radius_mm_ * (q - c).normalized());
    }
    return it->second;
  }
  void add_face(int axis, double side) {
    constexpr double kStep_mm = 2;
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const auto us = ticks(core_mm_[u], radius_mm_, kStep_mm);
    const auto vs = ticks(core_mm_[v], radius_mm_, kStep_mm);
    const auto corner = [&](std::size_t i, std::size_t j) {
      Vector3d q;
      q[axis] = side * half_mm_[axis];
      q[u] = us[i];
      q[v] = vs[j];
      return vertex(q);
    };
    for (std::size_t i = 0; i + 1 < us.size(); ++i) {
      for (std::size_t j = 0; j + 1 < vs.size(); ++j) {
        const int a = corner(i, j), b = corner(i + 1, j);
        const int c = corner(i + 1, j + 1), d = corner(i, j + 1);
        if (side > 0) model.triangles.insert(model.triangles.end(), {{a, b, c}, {a, c, d}});
        if (side < 0) model.triangles.insert(model.triangles.end(), {{a, c, b}, {a, d, c}});
      }
    }
  }

  Vector3d half_mm_, core_mm_;
  double radius_mm_;
  std::map<std::array<long, 3>, int> index_;
};

struct Body {
  std::string name;
  mesh::Model model;
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
};

/// The bodies, models as their files lie, about 100 mm long.
Body body_of(const std::string& name, const fs::path& models) {
  const auto turned = [](double deg, const Vector3d& axis) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(deg * std::numbers::pi / 180, axis.normalized()));
  };
  const auto read = [&](const char* file, double scale) {
    return value_of(mesh::read_model(models / file, scale, Context{}));
  };
  if (name == "spot") return {name, read("spot/spot_triangulated.obj", 50)};
  if (name == "bunny") return {name, read("bunny/bunny_hr.obj", 65)};
  if (name == "head") return {name, read("head/LeePerrySmith_converted.obj", 12)};
  if (name == "bottle") return {name, read("bottle/WaterBottle_converted.obj", 400)};
  if (name == "mug") return {name, read("mug/mug.obj", 10)};
  if (name == "cat") return {name, read("cat/cat-low-resolution.obj", 30)};
  if (name == "board") {
    return {name, RoundedBox({100, 80, 10}, 3).model,
            turned(30, {1, 0.4, 0.1}) * turned(90, Vector3d::UnitX())};
  }
  return {"box", RoundedBox({60, 50, 40}, 8).model, turned(35, {1, 0.6, 0.2})};
}

DipOptions options_of(const Body& body, FilmModel model) {
  DipOptions options;
  options.X_FO = Pose(body.turn);
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : body.model.vertices) box.extend(body.turn * p);
  options.X_FO->translation() = -box.center();
  options.outline = value_of(film::parse_outline("A4"));
  options.film_model = model;
  options.map.make_tiles = false;
  return options;
}

/// Other distances of waterlines, and all lengths of the film mesh times a factor.
DipOptions with(DipOptions options, double swept_mm, double mesh_factor) {
  options.schedule.swept_mm = swept_mm;
  options.mesh.size.at_waterline_mm *= mesh_factor;
  options.mesh.size.growth *= mesh_factor;
  options.mesh.size.most_mm *= mesh_factor;
  options.mesh.spacing_mm *= mesh_factor;
  options.mesh.tolerance_mm *= mesh_factor;
  return options;
}

struct Run {
  pipeline::Dip dip;
  double cpu_s = 0;
};

Run run(const Body& body, const DipOptions& options) {
  const std::clock_t begin = std::clock();
  Run out{value_of(pipeline::dip(body.model, options, testing::two_threads()))};
  out.cpu_s = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  return out;
}

/// What a reference has of a point of the surface: its film point, and the stretch there.
struct Point {
  float x_mm, y_mm, stretch;
};

/// Every so many points of a surface are in its reference.
std::size_t stride(std::size_t points) { return points / 2000 + 1; }

std::vector<Point> points_of(const pipeline::Dip& dip) {
  const flow::SurfaceMap& map = dip.map.surface;
  std::vector<Point> out;
  for (std::size_t v = 0; v < map.film_mm.size(); v += stride(map.film_mm.size())) {
    out.push_back({static_cast<float>(map.film_mm[v].x()), static_cast<float>(map.film_mm[v].y()),
                   static_cast<float>(map.stretch[v])});
  }
  return out;
}

void write_reference(const fs::path& path, const Body& body, FilmModel model) {
  DipOptions fine = options_of(body, model);
  fine.schedule.most = 100'000;
  fine.sheet.tolerance_mm /= 3;
  fine.sheet.most_sweeps += 4;
  const double swept_mm = model == FilmModel::kStokes ? 0.8 : 3.2 / 3;
  const auto points = points_of(run(body, with(fine, swept_mm, 1.0 / 3)).dip);
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(points.data()),
             static_cast<std::streamsize>(points.size() * sizeof(Point)));
}

std::vector<Point> read_reference(const fs::path& path, std::size_t count) {
  std::vector<Point> out(count);
  const auto bytes = static_cast<std::streamsize>(count * sizeof(Point));
  if (!std::ifstream(path, std::ios::binary).read(reinterpret_cast<char*>(out.data()), bytes)) {
    give_up(
        {Code::kNotFound, path.string() + ": no reference of this surface. Write it again", {}});
  }
  return out;
}

/// Distances on the film between a dip and its reference, and the stated errors, mm.
struct Errors {
  std::vector<double> true_mm, stated_mm;

  [[nodiscard]] double quantile_mm(double q) const {
    if (true_mm.empty()) return 0;
    std::vector<double> sorted = true_mm;
    std::ranges::sort(sorted);
    return sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
  }
  /// Returns those with a bound, or those without, because their film had torn.
  [[nodiscard]] Errors bounded(bool is_bounded) const {
    Errors out;
    for (std::size_t i = 0; i < true_mm.size(); ++i) {
      if (std::isfinite(stated_mm[i]) != is_bounded) continue;
      out.true_mm.push_back(true_mm[i]);
      out.stated_mm.push_back(stated_mm[i]);
    }
    return out;
  }
  [[nodiscard]] double covered() const {
    double out = 0;
    for (std::size_t i = 0; i < true_mm.size(); ++i) out += true_mm[i] <= stated_mm[i] ? 1 : 0;
    return out / static_cast<double>(true_mm.size());
  }
  [[nodiscard]] double share_above(double limit_mm) const {
    if (true_mm.empty()) return 0;
    const auto count = std::ranges::count_if(true_mm, [&](double e) { return e > limit_mm; });
    return static_cast<double>(count) / static_cast<double>(true_mm.size());
  }
};

/// Only of film that is not torn in the reference and that arrives in both.
Errors errors_of(const pipeline::Dip& dip, const fs::path& reference, double tear_stretch) {
  const std::vector<Point> points = points_of(dip);
  const std::vector<Point> exact = read_reference(reference, points.size());
  const std::vector<double>& stated_mm = dip.map.surface.error_mm;
  Errors out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!(exact[i].stretch < tear_stretch) || std::isnan(points[i].x_mm)) continue;
    out.true_mm.push_back(
        std::hypot(points[i].x_mm - exact[i].x_mm, points[i].y_mm - exact[i].y_mm));
    if (!stated_mm.empty()) out.stated_mm.push_back(stated_mm[i * stride(stated_mm.size())]);
  }
  return out;
}

void compare(const Body& body, const std::string& model, const DipOptions& options,
             const fs::path& reference) {
  constexpr double kSweptBefore_mm = 3.2, kMeshBefore = 2.0 / 3;
  const double tear = options.profile.tear_stretch;
  DipOptions before = with(options, kSweptBefore_mm, kMeshBefore);
  before.states_error = false;
  const Run now = run(body, options), then = run(body, before);
  const Errors errors = errors_of(now.dip, reference, tear);
  const Errors bounded = errors.bounded(true), unbounded = errors.bounded(false);
  std::vector<double> stated_mm = bounded.stated_mm;
  std::ranges::sort(stated_mm);
  print(body.name + "-" + model,
        {{"p50_mm", errors.quantile_mm(0.5)},
         {"p95_mm", errors.quantile_mm(0.95)},
         {"p99_mm", errors.quantile_mm(0.99)},
         {"p95_before_mm", errors_of(then.dip, reference, tear).quantile_mm(0.95)},
         {"bounded_p50_mm", bounded.quantile_mm(0.5)},
         {"bounded_p95_mm", bounded.quantile_mm(0.95)},
         {"covered", bounded.covered()},
         {"stated_p50_mm", stated_mm[stated_mm.size() / 2]},
         {"no_bound", static_cast<double>(unbounded.true_mm.size()) /
                          static_cast<double>(errors.true_mm.size())},
         {"no_bound_p95_mm", unbounded.quantile_mm(0.95)},
         {"above_1mm", errors.share_above(1)},
         {"no_bound_above_1mm", unbounded.share_above(1)},
         {"cpu_s", now.cpu_s},
         {"cpu_before_s", then.cpu_s},
         {"waterlines", now.dip.figures.steps}});
}

void print_table(const Body& body, const std::string& model, const DipOptions& options,
                 const fs::path& reference) {
  for (const double swept_mm : {3.2, 2.4, 1.6, 1.2}) {
    for (const double mesh : {1.0, 1.5, 2.0}) {
      const Run of = run(body, with(options, swept_mm, mesh / 1.5));
      const Errors errors = errors_of(of.dip, reference, options.profile.tear_stretch);
      print(body.name + "-" + model, {{"swept_mm", swept_mm},
                                      {"mesh", mesh},
                                      {"p50_mm", errors.quantile_mm(0.5)},
                                      {"p95_mm", errors.quantile_mm(0.95)},
                                      {"cpu_s", of.cpu_s}});
    }
  }
}

}  // namespace
}  // namespace hydroprint::bench

int main(int argc, char** argv) {
  using namespace hydroprint;
  if (argc != 6) {
    std::fputs(
        "usage: bench_bodies_error compare|table|write BODY stokes|sheet MODELS REFERENCES\n",
        stderr);
    return 2;
  }
  const std::string verb = argv[1], model = argv[3];
  const bench::Body body = bench::body_of(argv[2], argv[4]);
  const auto film_model =
      model == "sheet" ? pipeline::FilmModel::kSheet : pipeline::FilmModel::kStokes;
  const std::filesystem::path reference =
      std::filesystem::path(argv[5]) / (body.name + "-" + model + ".bin");
  const pipeline::DipOptions options = bench::options_of(body, film_model);
  if (verb == "write") bench::write_reference(reference, body, film_model);
  if (verb == "table") bench::print_table(body, model, options, reference);
  if (verb == "compare") bench::compare(body, model, options, reference);
}
