#include "sim/scan/volume.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace hydroprint::scan {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

// Range of a depth camera.
constexpr double kNear_mm = 250;
constexpr double kFar_mm = 2500;
/// Largest |x/z| and |y/z| of a point; the polynomial of a lens is not valid beyond this.
constexpr double kWidestTangent = 0.8;
/// Fraction of the truncation above which distances are unusable.
constexpr double kSaturated = 0.95;
/// Largest slope of distances on a real surface, 1 / cos(66 degrees). Beyond the edge of a surface,
/// positive distances of the space seen there meet negative ones assumed behind the surface, with a
/// steeper slope. That zero crossing is not a surface.
constexpr double kSteepest = 2.5;
constexpr int kMarkEvery_px = 4;  ///< small enough not to skip a block

Vector3i block_of_cell(const Vector3i& cell) {  // kSide is 8; also rounds down below zero
  return {cell.x() >> 3, cell.y() >> 3, cell.z() >> 3};
}

std::size_t in_block(const Vector3i& cell) {
  return static_cast<std::size_t>(((cell.z() & 7) << 6) | ((cell.y() & 7) << 3) | (cell.x() & 7));
}

/// Returns the reported depth at the pixel that sees a point; 0 if the point is out of view.
double reported_at(const DepthFrame& frame, const Lens& lens, const Vector3d& p_C) {
  if (p_C.z() < kNear_mm ||
      std::max(std::abs(p_C.x()), std::abs(p_C.y())) > kWidestTangent * p_C.z())
    return 0;
  const Eigen::Vector2d pixel = lens.project(p_C).array().round();
  if (!(pixel.x() >= 0 && pixel.x() < frame.width_px && pixel.y() >= 0 &&
        pixel.y() < frame.height_px))
    return 0;
  return frame.depth_mm[frame.index(static_cast<int>(pixel.x()), static_cast<int>(pixel.y()))];
}

/// Returns true if the distance changes by more than `most` along an edge of the cube.
bool leaps(const std::array<double, 8>& distances, double most) {
  for (std::size_t c = 0; c < 8; ++c)
    for (const std::size_t bit : {1U, 2U, 4U})
      if (std::abs(distances[c] - distances[c ^ bit]) > most) return true;
  return false;
}

/// Returns the weight in [0, 1] of a distance in units of the truncation. It is lower far behind a
/// surface, because the surface may be thin or end nearby.
double trust(double distance) { return std::min(1.0, 2 * (1 + distance)); }

}  // namespace

Volume::Volume(const Eigen::AlignedBox3d& box_mm, const Options& options)
    : options_(options), origin_mm_(box_mm.min()) {
  const Vector3d blocks = (box_mm.max() - box_mm.min()) / (kSide * options.voxel_mm);
  count_ = blocks.array().ceil().cwiseMax(1).cast<int>();
  table_.assign(static_cast<std::size_t>(count_.x()) * static_cast<std::size_t>(count_.y()) *
                    static_cast<std::size_t>(count_.z()),
                -1);
}

Vector3i Volume::cell_of(const Vector3d& p_W) const {
  return ((p_W - origin_mm_) / options_.voxel_mm).array().floor().cast<int>();
}

Vector3d Volume::centre(const Vector3i& cell) const {
  return origin_mm_ + options_.voxel_mm * (cell.cast<double>().array() + 0.5).matrix();
}

bool Volume::contains(const Vector3i& block) const {
  return (block.array() >= 0).all() && (block.array() < count_.array()).all();
}

std::size_t Volume::place_in_table(const Vector3i& block) const {
  return (static_cast<std::size_t>(block.z()) * static_cast<std::size_t>(count_.y()) +
          static_cast<std::size_t>(block.y())) *
             static_cast<std::size_t>(count_.x()) +
         static_cast<std::size_t>(block.x());
}

const Volume::Block* Volume::block_of(const Vector3i& cell) const {
  const Vector3i block = block_of_cell(cell);
  if (!contains(block)) return nullptr;
  const std::int32_t index = table_[place_in_table(block)];
  return index < 0 ? nullptr : &blocks_[static_cast<std::size_t>(index)];
}

const Volume::Voxel* Volume::voxel(const Vector3i& cell) const {
  const Block* block = block_of(cell);
  if (block == nullptr) return nullptr;
  const Voxel& found = (*block)[in_block(cell)];
  return found.weight > 0 ? &found : nullptr;
}

std::optional<double> Volume::distance_mm(const Vector3d& p_W) const {
  // The position in voxels, relative to the centre of the first voxel.
  const Vector3d at = ((p_W - origin_mm_) / options_.voxel_mm).array() - 0.5;
  const Vector3i low = at.array().floor().cast<int>();
  const Vector3d share = at - low.cast<double>();
  const bool is_inside = (low.x() & 7) != 7 && (low.y() & 7) != 7 && (low.z() & 7) != 7;
  const Block* block = is_inside ? block_of(low) : nullptr;
  if (is_inside && block == nullptr) return std::nullopt;
  double distance = 0;
  for (int c = 0; c < 8; ++c) {
    const Vector3i step = cube_corner(c);
    const Voxel* v = is_inside ? &(*block)[in_block(low + step)] : voxel(low + step);
    if (v == nullptr || v->weight <= 0) return std::nullopt;
    double part = v->distance;
    for (int i = 0; i < 3; ++i) part *= step[i] == 1 ? share[i] : 1 - share[i];
    distance += part;
  }
  return options_.truncation_mm * distance;
}

std::optional<Volume::Slope> Volume::slope(const Vector3d& p_W, double reach_mm) const {
  const auto within = [&](const std::optional<double>& distance) {
    return distance && std::abs(*distance) < kSaturated * options_.truncation_mm;
  };
  const auto here = distance_mm(p_W);
  if (!within(here)) return std::nullopt;
  Slope out{*here, {}};
  for (int i = 0; i < 3; ++i) {
    const Vector3d step = reach_mm * Vector3d::Unit(i);
    const auto before = distance_mm(p_W - step), after = distance_mm(p_W + step);
    if (!within(before) || !within(after)) return std::nullopt;
    out.gradient[i] = (*after - *before) / (2 * reach_mm);
  }
  return out;
}

/// Marks the blocks along the surface in a frame; creates missing ones.
Status Volume::mark_surface(const DepthFrame& frame, const Optics& optics, const Pose& X_WC,
                            std::vector<char>& marked) {
  const auto mark = [&](const Vector3d& p_W) {
    const Vector3i block = block_of_cell(cell_of(p_W));
    if (!contains(block)) return;
    std::int32_t& index = table_[place_in_table(block)];
    if (index < 0) {
      index = static_cast<std::int32_t>(blocks_.size());
      blocks_.emplace_back();
      places_.push_back(block);
      marked.push_back(0);
    }
    marked[static_cast<std::size_t>(index)] = 1;
  };
  for (int v = 0; v < frame.height_px; v += kMarkEvery_px) {
    for (int u = 0; u < frame.width_px; u += kMarkEvery_px) {
      const std::size_t i = frame.index(u, v);
      if (frame.depth_mm[i] <= 0) continue;
      const double depth_mm = optics.lens.true_depth_mm(frame.depth_mm[i]);
      const double beyond = options_.truncation_mm / optics.rays[i].norm();
      for (const double z : {depth_mm - beyond, depth_mm, depth_mm + beyond})
        mark(X_WC * (z * optics.rays[i]));
      if (blocks_.size() > options_.most_blocks)
        return fail(
            Code::kResourceExhausted,
            fmt::format("the scan is larger than {} blocks of voxels. Keep the camera pointed at "
                        "the rig, or use larger voxels",
                        options_.most_blocks));
    }
  }
  return {};
}

/// Marks the blocks in front of the surface in a frame. They are empty now, even if earlier frames
/// had a surface there.
void Volume::mark_before_surface(const DepthFrame& frame, const Optics& optics, const Pose& X_CW,
                                 std::vector<char>& marked) const {
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (marked[i] != 0) continue;
    const Vector3d middle_C = X_CW * (centre(kSide * places_[i]) +
                                      Vector3d::Constant((kSide - 1) / 2.0 * options_.voxel_mm));
    const double reported_mm = reported_at(frame, optics.lens, middle_C);
    if (reported_mm > 0 && optics.lens.true_depth_mm(reported_mm) > middle_C.z()) marked[i] = 1;
  }
}

void Volume::add_to(std::size_t block, const DepthFrame& frame, const Lens& lens,
                    const DepthNoise& noise, const Pose& X_CW) {
  Block& voxels = blocks_[block];
  const Vector3d first_C = X_CW * centre(kSide * places_[block]);
  const Eigen::Matrix3d step_C = options_.voxel_mm * X_CW.linear();
  for (int i = 0; i < kSide * kSide * kSide; ++i) {
    const Vector3d p_C = first_C + step_C * Vector3d(i & 7, i >> 3 & 7, i >> 6);
    const double reported_mm = reported_at(frame, lens, p_C);
    if (reported_mm <= 0) continue;
    const double along_mm =
        (lens.true_depth_mm(reported_mm) - p_C.z()) * p_C.norm() / p_C.z();  // along the ray
    if (along_mm < -options_.truncation_mm) continue;
    const double sigma_mm = noise.sigma_mm(reported_mm);
    const auto weight =
        static_cast<float>(trust(along_mm / options_.truncation_mm) / (sigma_mm * sigma_mm));
    const auto distance = static_cast<float>(std::min(1.0, along_mm / options_.truncation_mm));
    Voxel& voxel = voxels[static_cast<std::size_t>(i)];
    voxel.distance = (voxel.distance * voxel.weight + distance * weight) / (voxel.weight + weight);
    voxel.weight += weight;
  }
}

Status Volume::add(const DepthFrame& frame, const Optics& optics, const DepthNoise& noise,
                   const Pose& X_WC, const Context& context) {
  if (frame.width_px != optics.lens.width_px || frame.height_px != optics.lens.height_px)
    return fail(Code::kInvalidArgument,
                "the lens calibration is for another resolution. Calibrate the camera at the "
                "resolution of the frames");
  const Pose X_CW = X_WC.inverse();
  std::vector<char> marked(blocks_.size(), 0);
  HP_RETURN_IF_ERROR(mark_surface(frame, optics, X_WC, marked));
  mark_before_surface(frame, optics, X_CW, marked);
  std::vector<std::size_t> seen;
  for (std::size_t i = 0; i < marked.size(); ++i)
    if (marked[i] != 0) seen.push_back(i);
  return parallel_for(context, "", seen.size(), [&](std::size_t i) -> Status {
    add_to(seen[i], frame, optics.lens, noise, X_CW);
    return {};
  });
}

/// Returns the distance along a ray of unit direction to the first surface that it hits from the
/// front.
std::optional<double> Volume::first_hit_mm(const Vector3d& from, const Vector3d& along) const {
  // Distance along the ray, and the positive value of the volume there.
  std::optional<std::pair<double, double>> before;
  for (double way = kNear_mm; way < kFar_mm;) {
    const Vector3d p = from + way * along;
    if (block_of(cell_of(p)) == nullptr) {
      before.reset();
      way += kSide / 2 * options_.voxel_mm;
      continue;
    }
    const auto distance = distance_mm(p);
    if (!distance) {
      before.reset();
      way += options_.voxel_mm;
    } else if (*distance > 0) {
      before = {way, *distance};
      way += std::max(options_.voxel_mm / 2, 0.8 * *distance);
    } else if (before) {
      return before->first + (way - before->first) * before->second / (before->second - *distance);
    } else {
      return std::nullopt;  // the surface is seen from behind
    }
  }
  return std::nullopt;
}

Result<PointGrid> Volume::look(const Optics& optics, const Pose& X_WV,
                               const Context& context) const {
  PointGrid out{optics.lens.width_px, optics.lens.height_px, {}};
  out.points.assign(optics.rays.size(), Vector3d::Zero());
  const auto look_row = [&](std::size_t row) -> Status {
    for (int u = 0; u < out.width_px; ++u) {
      const std::size_t i = out.index(u, static_cast<int>(row));
      const Vector3d along = optics.rays[i].normalized();
      const auto way_mm = first_hit_mm(X_WV.translation(), X_WV.linear() * along);
      if (way_mm) out.points[i] = *way_mm * along;
    }
    return {};
  };
  HP_RETURN_IF_ERROR(parallel_for(context, "", static_cast<std::size_t>(out.height_px), look_row));
  return out;
}

TriangleMesh Volume::surface(double least_weight) const {
  MarchingTetrahedra marching(kSide * count_, origin_mm_, options_.voxel_mm);
  for (const Vector3i& place : places_) {
    for (int i = 0; i < kSide * kSide * kSide; ++i) {
      const Vector3i cell = kSide * place + Vector3i(i & 7, i >> 3 & 7, i >> 6);
      std::array<double, 8> distances{};
      bool is_known = true;
      for (int c = 0; c < 8 && is_known; ++c) {
        const Voxel* v = voxel(cell + cube_corner(c));
        is_known = v != nullptr && v->weight >= least_weight;
        if (is_known) distances[static_cast<std::size_t>(c)] = v->distance;
      }
      if (is_known && !leaps(distances, kSteepest * options_.voxel_mm / options_.truncation_mm))
        marching.add(cell, distances);
    }
  }
  return std::move(marching).mesh();
}

}  // namespace hydroprint::scan
