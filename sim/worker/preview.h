#pragma once

#include "sim/base/result.h"
#include "sim/worker/ending.h"
#include "sim/worker/options.h"

namespace hydroprint::worker {

/// `hydroprint-worker preview`: reads the model once and answers, for as long as somebody asks, how
/// a dip of it would roughly go (pipeline::preview_of), for a page on which the object is turned.
///
/// Requests come on stdin, a JSON object a line:
///   {"id": 7, "pose": {"rotation_wxyz": [1, 0, 0, 0], "translation_mm": [0, 0, 0]}, "film": "A3",
///    "depth_mm": 30, "dip_speed_mm_per_s": 5}
/// of which only `id` (a whole number) has to be there; the others default to the command line's.
/// Each is answered on stdout, by a JSON object on a line and as many bytes after it as its `bytes`
/// says, little-endian. First of all comes the model:
///   {"vertices", "triangles", "bytes", "warnings"}: a float x, y, z (frame O, mm) for each vertex,
///   then three uint32 for each triangle
/// and then, for each request,
///   {"id", "bytes", "pose", "depth_mm", "coverage", "theta_clamped_share", "stretch", "seconds",
///    "warnings"}: for each vertex four floats, film_x, film_y, contact_time, stretch, as in
///   surface_map.ply: NaN where no film arrives
/// or {"id", "bytes": 0, "error": {"code", "reason", "message"}}, with the reason SUPERSEDED if a
/// newer request came before this one was done. (`id` is -1 of what is no request.)
/// Ends with stdin.
[[nodiscard]] Status run_preview(const Options& options, Ending& ending);

}  // namespace hydroprint::worker
