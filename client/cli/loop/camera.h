#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "client/cli/program/program.h"
#include "sim/base/result.h"

namespace hydroprint::cli {

/// Calibrates the virtual rig's camera as one does a real one: the calibration board is held before
/// it in twelve ways, each a capture, and a job finds lens and depth scale.
/// @param control  of the virtual rig
/// @param folder   for the board's mesh and where it is held
/// @param seed     of how it is held
/// @return the calibration, "calibrations/2", which is then the active one of a camera
[[nodiscard]] Result<std::string> calibrate_loop_camera(Program& program,
                                                        const std::string& control,
                                                        const std::filesystem::path& folder,
                                                        std::uint32_t seed);

}  // namespace hydroprint::cli
