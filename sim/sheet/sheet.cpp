#include "sim/sheet/sheet.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "sim/base/check.h"
#include "sim/velocity/quadratic_elements.h"

namespace hydroprint::velocity {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
// The numbering of the unknowns already has low fill (FilmMesh::elimination_order).
using Factor = Eigen::SimplicialLLT<Matrix, Eigen::Lower, Eigen::NaturalOrdering<int>>;

/// Returns the integral of 2 (D(u) : D(v) + tr D(u) tr D(v)) over one triangle. Quadrature at the
/// midpoints of the edges is exact for quadratic functions.
ElementMatrix stiffness(const FilmMesh& mesh, std::size_t t) {
  const double twice_area = twice_area_mm2(mesh, t);
  ElementMatrix K = ElementMatrix::Zero();
  for (int m = 0; m < 3; ++m) {
    Eigen::Vector3d middle = Eigen::Vector3d::Constant(0.5);
    middle[m] = 0;
    const auto g = shape_gradients(mesh, t, middle);
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j <= i; ++j) {
        const Eigen::Matrix2d cross = g.row(i).transpose() * g.row(j);
        const double dot = cross.trace();
        K.block<2, 2>(2 * i, 2 * j) +=
            twice_area / 6 * (2 * cross + cross.transpose() + dot * Eigen::Matrix2d::Identity());
      }
    }
  }
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < i; ++j) {
      K.block<2, 2>(2 * j, 2 * i) = K.block<2, 2>(2 * i, 2 * j).transpose();
    }
  }
  return K;
}

constexpr double kTolerance = 1e-7;  ///< relative error of the velocities in conjugate gradients
constexpr int kMostIterations = 12;  ///< with more iterations, a new factorisation is cheaper
constexpr int kFewIterations = 3;    ///< enough to estimate the total number of iterations

}  // namespace

struct Sheet::State {
  State(const FilmMesh& film, double drag, std::vector<Eigen::Vector2d> prescribed);

  void assemble(const std::vector<double>& thickness_mm);
  [[nodiscard]] bool factorize();
  [[nodiscard]] bool iterate();
  [[nodiscard]] std::vector<Eigen::Vector2d> velocities() const;

  const FilmMesh& mesh;
  double drag_per_mm;
  std::vector<Eigen::Vector2d> fixed;
  Unknowns unknowns;
  std::vector<ElementMatrix> element;  ///< matrix of each triangle, for unit thickness
  /// For each triangle, the index of each element entry among the matrix's values; -1: not stored.
  std::vector<std::array<int, 144>> place;
  Matrix matrix;  ///< lower triangle
  Eigen::VectorXd load, solution;
  Factor factor;
  bool has_factor = false;

 private:
  [[nodiscard]] std::array<int, 12> rows_of(std::size_t triangle) const;
  void find_places();
};

Sheet::State::State(const FilmMesh& film, double drag, std::vector<Eigen::Vector2d> prescribed)
    : mesh(film), drag_per_mm(drag), fixed(std::move(prescribed)), unknowns(film, fixed) {
  element.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) element.push_back(stiffness(mesh, t));
  find_places();
}

/// Returns the matrix row of each of a triangle's twelve velocity components; -1: prescribed.
std::array<int, 12> Sheet::State::rows_of(std::size_t triangle) const {
  std::array<int, 12> rows;
  const auto node = nodes_of(mesh, triangle);
  for (int i = 0; i < 6; ++i) {
    const int unknown = unknowns.of_node[node[i]];
    rows[2 * i] = unknown < 0 ? -1 : 2 * unknown;
    rows[2 * i + 1] = unknown < 0 ? -1 : 2 * unknown + 1;
  }
  return rows;
}

void Sheet::State::find_places() {
  const int size = 2 * unknowns.count;
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(78 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto rows = rows_of(t);
    for (int i = 0; i < 12; ++i) {
      for (int j = 0; j < 12; ++j) {
        if (rows[j] >= 0 && rows[i] >= rows[j]) entries.emplace_back(rows[i], rows[j], 0.0);
      }
    }
  }
  matrix.resize(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  place.resize(mesh.triangles.size());
  const int* start = matrix.outerIndexPtr();
  const int* inner = matrix.innerIndexPtr();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto rows = rows_of(t);
    for (int i = 0; i < 12; ++i) {
      for (int j = 0; j < 12; ++j) {
        int& at = place[t][12 * i + j];
        at = -1;
        if (rows[j] < 0 || rows[i] < rows[j]) continue;
        const int* end = inner + start[rows[j] + 1];
        at = static_cast<int>(std::lower_bound(inner + start[rows[j]], end, rows[i]) - inner);
      }
    }
  }
}

void Sheet::State::assemble(const std::vector<double>& thickness_mm) {
  std::fill_n(matrix.valuePtr(), matrix.nonZeros(), 0.0);
  load = Eigen::VectorXd::Zero(matrix.rows());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    ElementMatrix K = thickness_mm[t] * element[t];
    if (drag_per_mm > 0) K += 0.5 * twice_area_mm2(mesh, t) * drag_per_mm * unit_mass();
    for (int e = 0; e < 144; ++e) {
      if (place[t][e] >= 0) matrix.valuePtr()[place[t][e]] += K(e / 12, e % 12);
    }
    const auto node = nodes_of(mesh, t);
    for (int j = 0; j < 6; ++j) {
      if (unknowns.of_node[node[j]] >= 0) continue;
      for (int i = 0; i < 6; ++i) {
        const int unknown = unknowns.of_node[node[i]];
        if (unknown < 0) continue;
        load.segment<2>(2 * unknown) -= K.block<2, 2>(2 * i, 2 * j) * fixed[node[j]];
      }
    }
  }
}

bool Sheet::State::factorize() {
  if (!has_factor) factor.analyzePattern(matrix);
  factor.factorize(matrix);
  has_factor = factor.info() == Eigen::Success;
  if (has_factor) solution = factor.solve(load);
  return has_factor;
}

/// Runs conjugate gradients from the previous solution, preconditioned by the factor of an earlier
/// matrix. Returns false if a new factorisation is cheaper.
bool Sheet::State::iterate() {
  const auto whole = matrix.selfadjointView<Eigen::Lower>();
  // Errors are measured by the power that they dissipate, because smooth errors have small
  // residuals.
  const double wanted = kTolerance * kTolerance * load.dot(solution);
  Eigen::VectorXd residual = load;
  residual -= whole * solution;
  Eigen::VectorXd along = factor.solve(residual);
  const double first = residual.dot(along);
  Eigen::VectorXd image(along.size());
  double left = first;
  for (int i = 1; !(left <= wanted); ++i) {
    image.setZero();
    image += whole * along;
    const double step = left / along.dot(image);
    solution += step * along;
    residual -= step * image;
    const Eigen::VectorXd towards = factor.solve(residual);
    const double next = residual.dot(towards);
    // Number of iterations, extrapolated from the convergence so far. The first few iterations show
    // if a factor is too old.
    const double expected = i * std::log(wanted / first) / std::log(next / first);
    const bool is_slow = i >= kFewIterations && !(next < first && expected < kMostIterations);
    if (!(next <= wanted) && (is_slow || i >= kMostIterations)) return false;
    along = towards + next / left * along;
    left = next;
  }
  return true;
}

std::vector<Eigen::Vector2d> Sheet::State::velocities() const {
  std::vector<Eigen::Vector2d> out = fixed;
  for (std::size_t n = 0; n < out.size(); ++n) {
    const int unknown = unknowns.of_node[n];
    if (unknown >= 0) out[n] = solution.segment<2>(2 * unknown);
  }
  return out;
}

Sheet::Sheet(const FilmMesh& mesh, double drag_per_mm, std::vector<Eigen::Vector2d> fixed)
    : state_(std::make_unique<State>(mesh, drag_per_mm, std::move(fixed))) {}
Sheet::~Sheet() = default;
Sheet::Sheet(Sheet&&) noexcept = default;
Sheet& Sheet::operator=(Sheet&&) noexcept = default;

Result<std::vector<Eigen::Vector2d>> Sheet::solve(const std::vector<double>& thickness_mm) {
  HP_CHECK(thickness_mm.size() == state_->mesh.triangles.size());
  State& s = *state_;
  if (s.unknowns.count == 0) return s.fixed;
  s.assemble(thickness_mm);
  if ((s.has_factor && s.iterate()) || s.factorize()) return s.velocities();
  return fail(Code::kInternal,
              "velocity: the film mesh gives a singular matrix for the sheet. "
              "Please report this");
}

}  // namespace hydroprint::velocity
