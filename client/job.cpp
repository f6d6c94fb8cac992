#include "client/job.h"

namespace hydroprint::client {

bool is_finished(v1::Job::State state) {
  return state == v1::Job::SUCCEEDED || state == v1::Job::FAILED || state == v1::Job::CANCELLED;
}

bool is_finished(const v1::Job& job) {
  const bool is_computed = !job.has_dip() && !job.has_print() && !job.has_capture();
  return is_finished(job.state()) || (!is_computed && job.state() == v1::Job::INTERRUPTED);
}

}  // namespace hydroprint::client
