#include "client/time.h"

#include <google/protobuf/util/time_util.h>

namespace hydroprint::client {

std::optional<Time> time_of(const google::protobuf::Timestamp& timestamp) {
  using google::protobuf::util::TimeUtil;
  if (timestamp.seconds() == 0 && timestamp.nanos() == 0) return std::nullopt;
  return Time(std::chrono::duration_cast<Time::duration>(
      std::chrono::nanoseconds(TimeUtil::TimestampToNanoseconds(timestamp))));
}

}  // namespace hydroprint::client
