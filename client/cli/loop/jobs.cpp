#include "client/cli/loop/jobs.h"

#include <Eigen/Geometry>

#include "client/cli/job_io/wait.h"
#include "client/jobs.h"

namespace hydroprint::cli {

Result<client::Job> finish_quietly(Program& program, const client::Job& job) {
  auto ended = client::watch_job(program.daemon(), job.name, [](const client::JobUpdate&) {});
  if (ended && ended->state != client::JobState::kSucceeded) return tl::unexpected(why(*ended));
  return ended;
}

Result<client::Job> run_quietly(Program& program, const client::Spec& spec) {
  HP_ASSIGN_OR_RETURN(const client::Job job, client::create_job(program.daemon(), spec, {}));
  return finish_quietly(program, job);
}

Result<client::Job> capture_quietly(Program& program, double seconds) {
  HP_ASSIGN_OR_RETURN(const client::Job job, client::create_capture(program.daemon(), seconds, {}));
  return finish_quietly(program, job);
}

client::PoseSpec spec_of(const Pose& pose) {
  const Eigen::Quaterniond q(pose.linear());
  const Eigen::Vector3d t = pose.translation();
  return {{q.w(), q.x(), q.y(), q.z()}, {t.x(), t.y(), t.z()}};
}

Pose pose_of(const client::PoseSpec& spec) {
  const auto& q = spec.rotation_wxyz;
  Pose out = Pose::Identity();
  out.linear() = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().matrix();
  out.translation() = Eigen::Vector3d(spec.translation_mm.data());
  return out;
}

}  // namespace hydroprint::cli
