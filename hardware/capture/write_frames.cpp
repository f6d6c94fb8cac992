#include "hardware/capture/write_frames.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "sim/base/artifact_file.h"
#include "sim/image/io/grey16.h"

namespace hydroprint::capture {
Status write_frames(const std::filesystem::path& folder, const depth_camera::SourceInfo& source,
                    const CapturedFrames& taken, const Context& context) {
  auto frames = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < taken.frames.size(); ++i) {
    HP_RETURN_IF_ERROR(check_cancelled(context));
    const depth_camera::DepthFrame& frame = taken.frames[i];
    const std::string file = fmt::format("frame-{:04}.png", i + 1);
    HP_RETURN_IF_ERROR(
        image::write_png(folder / file, {frame.width, frame.height, frame.depth_mm}));
    frames.push_back({{"file", file}, {"time_s", frame.time_s}, {"index", frame.index}});
    context.progress("writing",
                     static_cast<double>(i + 1) / static_cast<double>(taken.frames.size()));
  }
  const depth_camera::DepthFrame& first = taken.frames.front();
  const nlohmann::ordered_json out = {
      {"source", {{"uri", source.uri}, {"name", source.name}, {"serial", source.serial}}},
      {"width", first.width},
      {"height", first.height},
      {"depth_unit_mm", 1},
      {"horizontal_fov_rad", first.horizontal_fov_rad},
      {"vertical_fov_rad", first.vertical_fov_rad},
      {"lost_frames", taken.lost},
      {"left_out_frames", taken.left_out},
      {"frames", frames}};
  const std::string text = out.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  return image::write_artifact(
      folder / "frames.json",
      std::span(reinterpret_cast<const unsigned char*>(text.data()), text.size()));
}

}  // namespace hydroprint::capture
