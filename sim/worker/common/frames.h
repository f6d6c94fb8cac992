#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sim/base/context.h"
#include "sim/calibrate/frames_folder.h"
#include "sim/registration/camera/calibrate_camera.h"
#include "sim/registration/film_frame/film_frame.h"
#include "sim/worker/common/flags.h"
#include "sim/worker/common/input_folder.h"
#include "sim/worker/common/report.h"

namespace hydroprint::v1 {
class FilmFrameFacts;
}  // namespace hydroprint::v1

// Reading of depth frames, for calibrate, calibrate-camera and fuse. For inclusion in .cpp files
// only.
namespace hydroprint::worker {

/// Finds the folders written by hydroprint-capture among the files of a spec: those with a
/// frames.json. Returns fail_field() if there are none, or more than `most` (0: any number).
[[nodiscard]] Result<std::vector<std::filesystem::path>> frames_folders(
    const std::vector<std::filesystem::path>& files, std::size_t most);

/// Same as above, for the field `frames` of a spec.
template <class Spec>
Result<std::vector<std::filesystem::path>> frames_folders(const Spec& spec,
                                                          const InputFolder& inputs,
                                                          std::size_t most) {
  std::vector<std::filesystem::path> files;
  for (const v1::InputFile& file : spec.frames()) files.push_back(inputs.path(file));
  return frames_folders(files, most);
}

/// Adds the frames.json of each folder to the input files of report.json.
void append_frames(std::vector<InputPath>& files,
                   const std::vector<std::filesystem::path>& folders);

/// Adds `--frames DIR`.
void add_frames_flag(Flags& flags);

/// Depth frames and the calibration of their camera.
struct Scan {
  calibrate::Frames frames;
  registration::CameraCalibration camera;
};

/// Reads the frames of a folder, and the camera from its file. If `camera` is empty, the camera has
/// the driver's nominal values.
[[nodiscard]] Result<Scan> read_scan(const std::filesystem::path& folder,
                                     const std::filesystem::path& camera, const Context& context);

void set_film_frame(const registration::FilmFrame& frame, v1::FilmFrameFacts& out);

}  // namespace hydroprint::worker
