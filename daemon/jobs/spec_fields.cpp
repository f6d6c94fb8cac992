#include "daemon/jobs/spec_fields.h"

#include <fmt/format.h>

#include <algorithm>

namespace hydroprint::daemon {

Status check_frames(const std::string& kind, const InputFiles& frames, int most_views) {
  const int views = count_views(frames);
  if (views == 0) {
    return invalid_field(
        kind + ".frames",
        "do not include FOLDER/frames.json; name captures, or upload the files that "
        "hydroprint-capture writes");
  }
  if (views <= most_views) return {};
  return invalid_field(kind + ".frames",
                       fmt::format("have more than {} views; leave some out", most_views));
}

int count_views(const InputFiles& frames) {
  return static_cast<int>(std::count_if(
      frames.begin(), frames.end(),
      [](const v1::InputFile& file) { return file.name().ends_with("/frames.json"); }));
}

}  // namespace hydroprint::daemon
