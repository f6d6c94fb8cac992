#pragma once

#include <filesystem>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/scan/frame.h"
#include "sim/scan/lens.h"

namespace hydroprint::calibrate {

/// Frames as a camera took them, and what its driver says of its lens.
struct Frames {
  std::vector<scan::DepthFrame> frames;
  std::vector<double> times_s;  ///< of the frames; 0 where frames.json tells none
  scan::Lens nominal_lens;
};

/// No more frames than these are used of a folder: 10 s.
inline constexpr std::size_t kMostFrames = 300;

/// Reads a folder that hydroprint-capture wrote: frames.json and 16-bit PNGs of mm; the first
/// `most`. Refuses what read_json_file and read_grey16 refuse, a frames.json that is not such
/// a one (kInvalidArgument), and images of another size than it says (kDataLoss).
[[nodiscard]] Result<Frames> read_frames(const std::filesystem::path& folder,
                                         const Context& context, std::size_t most = kMostFrames);

}  // namespace hydroprint::calibrate
