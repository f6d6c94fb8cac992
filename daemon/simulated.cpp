#include "daemon/simulated.h"

#include "daemon/earlier_job.h"
#include "daemon/names.h"
#include "hydroprint/v1/job.pb.h"

namespace hydroprint::daemon {
namespace {

constexpr const char* kFilmImage = "film.png";
constexpr double kUsualDpi = 300;  // the worker's, of a simulation that was not told any

tl::unexpected<Error> taken(const std::string& field) {
  return invalid_field(field, "is taken from simulate_job; leave one of the two out");
}

Result<v1::SimulateSpec> simulation(const Job& job) {
  v1::Job body;
  if (body.ParseFromString(job.made.body) && body.has_simulate()) return body.simulate();
  return fail(Code::kInternal, job_name(job.id) + ": its spec cannot be read", "STORE_FAILED");
}

Status take(v1::PrintImageSpec& spec, JobStore& jobs, AssetStore& assets, const Layout& layout) {
  if (spec.has_film_image()) return taken("print_image.film_image");
  if (spec.has_film()) return taken("print_image.film");
  if (spec.has_dpi()) return taken("print_image.dpi");
  if (spec.extra_files_size() > 0) return taken("print_image.extra_files");
  HP_ASSIGN_OR_RETURN(const Job job, earlier_job(spec.simulate_job(), "simulate",
                                                 "print_image.simulate_job", jobs));
  const auto image = jobs.artifact(job.id, kFilmImage);
  if (!image) {
    return fail(Code::kFailedPrecondition,
                job_name(job.id) + " made no film.png; simulate with all artifacts",
                "STATE_FORBIDS");
  }
  HP_ASSIGN_OR_RETURN(const v1::SimulateSpec simulated, simulation(job));
  HP_ASSIGN_OR_RETURN(const Asset asset,
                      assets.adopt(layout.artifacts(job.id) / kFilmImage,
                                   {image->sha256, image->size_bytes, image->media_type, 0}));
  // Apart from whatever the simulation's own files are called.
  spec.mutable_film_image()->set_name("image/" + std::string(kFilmImage));
  spec.mutable_film_image()->set_asset("assets/" + asset.sha256);
  spec.set_dpi(simulated.has_dpi() ? simulated.dpi() : kUsualDpi);
  if (!simulated.has_film()) return {};
  spec.set_film(simulated.film());
  for (const v1::InputFile& file : simulated.extra_files()) {
    if (simulated.film() == "polygon:" + file.name()) *spec.add_extra_files() = file;
  }
  return {};
}

Status take(v1::TemplateSpec& spec, JobStore& jobs) {
  if (spec.has_mesh()) return taken("template.mesh");
  if (spec.extra_files_size() > 0) return taken("template.extra_files");
  if (spec.has_scale()) return taken("template.scale");
  if (spec.has_pose()) return taken("template.pose");
  if (spec.has_film()) return taken("template.film");
  HP_ASSIGN_OR_RETURN(const Job job,
                      earlier_job(spec.simulate_job(), "simulate", "template.simulate_job", jobs));
  HP_ASSIGN_OR_RETURN(const v1::SimulateSpec simulated, simulation(job));
  *spec.mutable_mesh() = simulated.mesh();
  *spec.mutable_extra_files() = simulated.extra_files();
  if (simulated.has_scale()) spec.set_scale(simulated.scale());
  if (simulated.has_pose()) *spec.mutable_pose() = simulated.pose();
  if (simulated.has_film()) spec.set_film(simulated.film());
  return {};
}

}  // namespace

Result<v1::Job> with_simulated(const v1::Job& job, JobStore& jobs, AssetStore& assets,
                               const Layout& layout) {
  v1::Job out = job;
  if (!job.print_image().simulate_job().empty()) {
    HP_RETURN_IF_ERROR(take(*out.mutable_print_image(), jobs, assets, layout));
  }
  if (!job.template_().simulate_job().empty()) {
    HP_RETURN_IF_ERROR(take(*out.mutable_template_(), jobs));
  }
  return out;
}

}  // namespace hydroprint::daemon
