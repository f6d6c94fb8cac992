#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "client/cli/program/program.h"
#include "sim/base/result.h"

namespace hydroprint::cli {

/// Calibrates the virtual rig's camera like a real one: holds the calibration board in front of it
/// in twelve poses, with one capture each, then finds lens and depth scale with a calibrate-camera
/// job.
/// @param control  control socket of the virtual rig
/// @param folder   folder for the files of the board's mesh and poses
/// @param seed     seed of the board's random poses
/// @return the calibration, "calibrations/2", which becomes the active camera calibration
[[nodiscard]] Result<std::string> calibrate_loop_camera(Program& program,
                                                        const std::string& control,
                                                        const std::filesystem::path& folder,
                                                        std::uint32_t seed);

}  // namespace hydroprint::cli
