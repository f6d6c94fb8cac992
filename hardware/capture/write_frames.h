#pragma once

#include <filesystem>

#include "hardware/capture/frames.h"
#include "hardware/depth_camera/depth_camera.h"
#include "sim/base/context.h"

namespace hydroprint::capture {

/// Writes frame-0001.png ... (16-bit grey, mm, 0: not measured), then frames.json: the source, its
/// image size and fields of view, and the file, time and index of every frame.
[[nodiscard]] Status write_frames(const std::filesystem::path& folder,
                                  const depth_camera::SourceInfo& source,
                                  const CapturedFrames& taken, const Context& context);

}  // namespace hydroprint::capture
