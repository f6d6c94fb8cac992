#include "daemon/jobs/adopted_files.h"

#include <fcntl.h>

#include "daemon/jobs/referenced_job.h"
#include "daemon/platform/durable_file.h"
#include "daemon/platform/resource_names.h"
#include "sim/base/sha256.h"

namespace hydroprint::daemon {
namespace {

constexpr int kMostArtifacts = 1000;

Result<v1::InputFile> adopt_file(const std::filesystem::path& file, const Asset& as,
                                 const std::string& name, const JobSources& sources) {
  HP_ASSIGN_OR_RETURN(const Asset asset, sources.assets.adopt(file, as));
  v1::InputFile out;
  out.set_name(name);
  out.set_asset("assets/" + asset.sha256);
  return out;
}

}  // namespace

Result<v1::InputFile> adopt_artifact(std::int64_t job, const Artifact& artifact,
                                     const std::string& name, const JobSources& sources) {
  HP_RETURN_IF_ERROR(sources.jobs.sound_artifact(job, artifact.name));
  return adopt_file(sources.layout.artifacts(job) / artifact.name,
                    {artifact.sha256, artifact.size_bytes, artifact.media_type, 0}, name, sources);
}

Result<v1::InputFile> adopt_text(const std::string& text, const std::string& name,
                                 const JobSources& sources) {
  const auto path = sources.layout.runs() / ("text-" + make_token());
  const auto adopt = [&]() -> Result<v1::InputFile> {
    HP_ASSIGN_OR_RETURN(const UniqueFd file, open_file(path, O_WRONLY | O_CREAT | O_EXCL));
    HP_RETURN_IF_ERROR(write_at(file, path, text, 0));
    return adopt_file(path,
                      {sha256(text), static_cast<std::int64_t>(text.size()), "application/toml", 0},
                      name, sources);
  };
  auto out = adopt();
  discard(path);
  return out;
}

Status adopt_frames(const std::string& capture, const std::string& field, const std::string& folder,
                    const JobSources& sources,
                    google::protobuf::RepeatedPtrField<v1::InputFile>& frames) {
  HP_ASSIGN_OR_RETURN(const Job job, earlier_job(capture, "capture", field, sources.jobs));
  HP_ASSIGN_OR_RETURN(const auto artifacts, sources.jobs.artifacts(job.id, "", kMostArtifacts));
  for (const Artifact& artifact : artifacts) {
    HP_ASSIGN_OR_RETURN(*frames.Add(),
                        adopt_artifact(job.id, artifact, folder + "/" + artifact.name, sources));
  }
  return {};
}

}  // namespace hydroprint::daemon
