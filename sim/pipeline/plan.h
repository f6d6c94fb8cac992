#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/pose.h"
#include "sim/base/result.h"
#include "sim/flow/surface_map.h"
#include "sim/image/figures/landed_ink.h"
#include "sim/image/io/rgb_image.h"
#include "sim/image/layers/layered_paint.h"
#include "sim/mesh/model.h"
#include "sim/mesh/surface.h"
#include "sim/pipeline/dip_images.h"
#include "sim/pipeline/pipeline.h"
#include "sim/plan/blend.h"
#include "sim/plan/regions.h"

namespace hydroprint::pipeline {

/// One of several dips of an object.
struct Immersion {
  std::optional<Pose> X_FO;        ///< see DipOptions
  std::optional<double> depth_mm;  ///< see DipOptions
};

/// Options for dividing a picture among several dips.
struct PlanOptions {
  std::filesystem::path mesh;
  double scale = 1;                              ///< millimetres per model unit
  std::optional<std::filesystem::path> texture;  ///< nullopt: the model's own colours
  std::optional<image::PaintSource> paint;       ///< instead of `texture`
  DipOptions dip;                     ///< of all dips; its pose, depth and ink are not used
  std::vector<Immersion> immersions;  ///< 1 to plan::kMaxDips
  double dpi = 300;
  int ink_passes = 1;  ///< see SimulateOptions
  double blend_mm = plan::kBlend_mm;
};

/// A dip of a plan under Stokes flow, by which the surface is divided.
struct PlannedDip {
  Pose X_FO;             ///< pose as used: lowest point on the water, z = 0
  flow::SurfaceMap map;  ///< on the points of Plan::surface
  DipFigures figures;    ///< of the whole surface
};

/// An object whose picture is divided among several dips (section 6).
struct Plan {
  mesh::Model model;
  mesh::Surface surface;  ///< shared by all dips
  image::LayeredPaint paint;
  std::vector<PlannedDip> dips;
  plan::Regions regions;
  plan::BlendWeights weights;
  std::vector<int> dip_at;                      ///< per point: its dip, from 1; 0: none
  std::vector<std::vector<double>> weights_at;  ///< per dip, then per point
  Warnings warnings;  ///< of the model, the division, and the dips' waterlines
};

/// Computes Stokes flow for each dip, divides the surface by least stretch, and computes how the
/// dips blend. Errors: those of the stages, for a dip with "dip N: " in front; kInvalidArgument for
/// a model without colours.
[[nodiscard]] Result<Plan> make_plan(const PlanOptions& options, const Context& context);

/// One dip of a plan with its final flow.
struct DipPrint {
  DipImages images;
  image::RgbImage stretch;  ///< picture of the stretch on the object
  image::LandedInk ink;     ///< that its film leaves on the object, seen as in combined_picture()
  flow::SurfaceMap map;     ///< final: with the ink of the image if the model is the sheet
  DipFigures own;           ///< its shares and stretch are those of the dip's region
  Warnings warnings;        ///< where the result in the region cannot be trusted
};

/// Computes the images of a dip, from 1: for the sheet, with the ink of the image itself.
[[nodiscard]] Result<DipPrint> print_dip(const Plan& plan, const PlanOptions& options, int dip,
                                         const Context& context);

/// Draws the object after all dips, in the orientation of the first one.
/// @param ink  of all dips: see image::add_ink()
[[nodiscard]] Result<image::RgbImage> combined_picture(const Plan& plan,
                                                       const image::LandedInk& ink,
                                                       const Context& context);

/// Returns the area of the object's surface, mm2.
[[nodiscard]] double surface_area_mm2(const Plan& plan);

/// Quantiles of the stretch over an area.
struct StretchQuantiles {
  double p50 = 0, p95 = 0, max = 0;
};

/// Returns the stretch over the surface, each point with its dip, by area; nullopt if there is
/// none.
/// @param dip  only the region of this dip; 0: of all dips
[[nodiscard]] std::optional<StretchQuantiles> stretch_of(const Plan& plan,
                                                         const std::vector<DipPrint>& prints,
                                                         int dip);

}  // namespace hydroprint::pipeline
