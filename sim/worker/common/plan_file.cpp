#include "sim/worker/common/plan_file.h"

#include <fmt/format.h>
#include <google/protobuf/stubs/logging.h>
#include <google/protobuf/util/json_util.h>

#include <utility>

#include "hydroprint/v1/report.pb.h"
#include "hydroprint/v1/spec.pb.h"
#include "sim/base/input_file.h"
#include "sim/film/outline.h"
#include "sim/worker/common/fields.h"
#include "sim/worker/common/object.h"
#include "sim/worker/common/surface_ply.h"

namespace hydroprint::worker {
namespace {

constexpr const char* kPlanJson = "plan.json";
constexpr const char* kPlanPly = "plan.ply";
constexpr std::size_t kMostBytes = 1 << 20;
constexpr const char* kAgain = "Make the plan again";

/// Marks an error as one of a file.
tl::unexpected<Error> of_file(Error error, const std::filesystem::path& file) {
  error.metadata["file"] = file.string();
  return tl::unexpected(std::move(error));
}

tl::unexpected<Error> refuse(const std::filesystem::path& file, const std::string& what) {
  return of_file(
      {Code::kInvalidArgument, fmt::format("{}: {}. {}", file.string(), what, kAgain), {}, {}},
      file);
}

Result<v1::Plan> read_plan(const std::filesystem::path& file) {
  const auto text = read_text_file(file, kMostBytes);
  if (!text) return of_file(text.error(), file);
  v1::Plan plan;
  const google::protobuf::LogSilencer silencer;
  const auto status = google::protobuf::util::JsonStringToMessage(*text, &plan);
  if (!status.ok()) return refuse(file, "not a plan: " + std::string(status.message()));
  if (plan.immersions().empty() || plan.immersions_size() > plan::kMaxDips)
    return refuse(file, fmt::format("has {} dips", plan.immersions_size()));
  if (!(plan.blend_mm() > 0 && plan.blend_mm() <= 1000))
    return refuse(file, "blend_mm is not a width");
  return plan;
}

Result<PlannedDipOptions> name_files(const InputFolder& inputs, const v1::SimulateSpec& spec) {
  PlannedDipOptions out;
  for (const v1::InputFile& file : spec.plan()) {
    const std::filesystem::path path = inputs.path(file);
    if (path.filename() == kPlanJson) out.plan_json = path;
    if (path.filename() == kPlanPly) out.plan_ply = path;
  }
  if (out.plan_json.empty() || out.plan_ply.empty()) {
    return fail_field(Code::kInvalidArgument, "plan",
                      "plan.json or plan.ply is missing. Name both files of the plan");
  }
  return out;
}

/// Fails if the spec sets a value other than the plan's.
template <class Value>
Status check_same(const char* field, bool is_set, const Value& own, const Value& planned) {
  if (!is_set || own == planned) return {};
  return fail_field(
      Code::kInvalidArgument, field,
      fmt::format("{}, but the plan has {}. Leave it out, or make another plan", own, planned));
}

/// Fails for another film than the plan's. Polygons are compared by the names of their files.
Status check_film(const std::string& own, const std::string& planned, const InputFolder& inputs) {
  const auto own_file = film::polygon_file(own), planned_file = film::polygon_file(planned);
  if (own_file && planned_file && own_file->filename() == planned_file->filename()) return {};
  HP_ASSIGN_OR_RETURN(const std::string film, inputs.film(own));
  return check_same("film", true, film, planned);
}

Status take_film(const v1::Plan& plan, const InputFolder& inputs, v1::SimulateSpec& spec) {
  HP_RETURN_IF_ERROR(check_same("scale", spec.has_scale(), spec.scale(), plan.scale()));
  spec.set_scale(plan.scale());
  const v1::FilmSetup& film = plan.film();
  const std::string planned = film.film().empty() ? ObjectOptions{}.film : film.film();
  if (spec.has_film()) {
    HP_RETURN_IF_ERROR(check_film(spec.film(), planned, inputs));
  } else {
    spec.set_film(planned);  // a polygon's file, as it was named then
  }
  if (!film.profile().name().empty() && spec.profile().name().empty()) {
    return fail_field(
        Code::kInvalidArgument, "profile",
        fmt::format("missing. The plan was made with {}; name that file", film.profile().name()));
  }
  if (!spec.has_dpi()) spec.set_dpi(plan.dpi());
  if (!spec.has_tolerance_mm() && film.has_tolerance_mm())
    spec.set_tolerance_mm(film.tolerance_mm());
  if (!spec.has_dip_speed_mm_per_s()) spec.set_dip_speed_mm_per_s(film.dip_speed_mm_per_s());
  if (spec.model() != v1::MODEL_UNSPECIFIED) return {};
  spec.set_model(film.model());
  spec.set_inertia(spec.inertia() || film.inertia());
  if (!spec.has_ink_passes() && film.model() != v1::MODEL_STOKES)
    spec.set_ink_passes(film.ink_passes());
  return {};
}

Status take_dip(const v1::Plan& plan, v1::SimulateSpec& spec) {
  const int dips = plan.immersions_size();
  if (!spec.has_immersion()) {
    return fail_field(Code::kInvalidArgument, "immersion",
                      fmt::format("missing. Give the number of the dip, from 1 to {}", dips));
  }
  if (spec.immersion() > dips || spec.immersion() < 1) {
    return fail_field(Code::kOutOfRange, "immersion",
                      fmt::format("{}, but the plan has {} dip{}. Give a number from 1 to {}",
                                  spec.immersion(), dips, dips == 1 ? "" : "s", dips));
  }
  const v1::DipSetup& dip = plan.immersions(spec.immersion() - 1);
  if (!spec.has_pose()) *spec.mutable_pose() = dip.pose();
  if (!spec.has_depth_mm() && dip.has_depth_mm()) spec.set_depth_mm(dip.depth_mm());
  return {};
}

}  // namespace

void add_plan_flag(Flags& flags) { flags.add_folder("plan", {kPlanJson, kPlanPly}); }

Result<PlannedDipOptions> take_plan(const InputFolder& inputs, v1::SimulateSpec& spec) {
  if (spec.plan().empty()) {
    if (!spec.has_immersion()) return PlannedDipOptions{};
    return fail_field(Code::kInvalidArgument, "immersion",
                      "needs a plan. Name its folder, or leave this out");
  }
  HP_ASSIGN_OR_RETURN(PlannedDipOptions out, name_files(inputs, spec));
  HP_ASSIGN_OR_RETURN(const v1::Plan plan, read_plan(out.plan_json));
  HP_RETURN_IF_ERROR(take_dip(plan, spec));
  HP_RETURN_IF_ERROR(take_film(plan, inputs, spec));
  HP_RETURN_IF_ERROR(check_fields(spec));
  out.mesh_sha256 = plan.mesh_sha256();
  out.share.dip = spec.immersion();
  out.share.blend_mm = plan.blend_mm();
  for (int k = 0; k < plan.immersions_size(); ++k) {
    const auto pose = pose_of(plan.immersions(k).pose());
    if (!pose) {
      return refuse(out.plan_json, fmt::format("the pose of dip {} is not usable ({})", k + 1,
                                               pose.error().message));
    }
    out.share.X_FO.push_back(*pose);
  }
  return out;
}

Result<pipeline::PlanShare> read_share(const PlannedDipOptions& options) {
  HP_ASSIGN_OR_RETURN(PlanSurface surface,
                      read_plan_surface(options.plan_ply, options.share.X_FO.size()));
  pipeline::PlanShare out = options.share;
  out.points = std::move(surface.points);
  out.triangles = std::move(surface.triangles);
  out.stretch = std::move(surface.stretch);
  return out;
}

}  // namespace hydroprint::worker
