#pragma once

#include <filesystem>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/scan/frame.h"
#include "sim/scan/lens.h"

namespace hydroprint::calibrate {

/// Recorded frames, and the driver's description of the lens.
struct Frames {
  std::vector<scan::DepthFrame> frames;
  std::vector<double> times_s;  ///< times of the frames; 0 if frames.json has none
  scan::Lens nominal_lens;
};

/// Maximum number of frames used from a folder: 10 s at 30 frames/s.
inline constexpr std::size_t kMostFrames = 300;

/// Reads the first `most` frames of a folder written by hydroprint-capture: frames.json and 16-bit
/// PNGs with depths in mm. Returns the errors of read_json_file() and read_grey16(),
/// kInvalidArgument if frames.json is malformed, and kDataLoss if the size of an image differs from
/// frames.json.
[[nodiscard]] Result<Frames> read_frames(const std::filesystem::path& folder,
                                         const Context& context, std::size_t most = kMostFrames);

}  // namespace hydroprint::calibrate
