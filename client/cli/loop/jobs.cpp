#include "client/cli/loop/jobs.h"

#include <Eigen/Geometry>

#include "client/cli/job_io/wait.h"
#include "client/jobs.h"

namespace hydroprint::cli {

Result<v1::Job> finish_quietly(Program& program, const v1::Job& job) {
  auto ended = client::watch_job(program.daemon(), job.name(), [](const v1::WatchJobResponse&) {});
  if (ended && ended->state() != v1::Job::SUCCEEDED) return tl::unexpected(why(*ended));
  return ended;
}

Result<v1::Job> run_quietly(Program& program, const v1::Job& job) {
  HP_ASSIGN_OR_RETURN(const v1::Job created, client::create_job(program.daemon(), job, {}));
  return finish_quietly(program, created);
}

Result<v1::Job> capture_quietly(Program& program, double seconds) {
  HP_ASSIGN_OR_RETURN(const v1::Job job, client::create_capture(program.daemon(), seconds, {}));
  return finish_quietly(program, job);
}

v1::Pose message_of(const Pose& pose) {
  const Eigen::Quaterniond q(pose.linear());
  v1::Pose message;
  for (const double x : {q.w(), q.x(), q.y(), q.z()}) message.add_rotation_wxyz(x);
  for (const double x : pose.translation()) message.add_translation_mm(x);
  return message;
}

Pose pose_of(const v1::Pose& message) {
  const auto& q = message.rotation_wxyz();
  Pose out = Pose::Identity();
  out.linear() = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().matrix();
  out.translation() = Eigen::Vector3d(message.translation_mm().data());
  return out;
}

}  // namespace hydroprint::cli
