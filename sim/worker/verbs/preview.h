#pragma once

#include "sim/worker/common/verb.h"

namespace hydroprint::worker {

/// Reads the model once and answers, request by request, how a dip of it would roughly go
/// (pipeline::preview_of), for a page on which the user turns the object. Its spec is that of
/// simulate, of which it uses what the dip needs: texture, resolution and model do not matter.
///
/// Requests come on stdin, a JSON object a line:
///   {"id": 7, "pose": {"rotation_wxyz": [1, 0, 0, 0], "translation_mm": [0, 0, 0]}, "film": "A3",
///    "depth_mm": 30, "dip_speed_mm_per_s": 5}
/// Only `id` (a whole number) is required; the others default to the command line's. Each is
/// answered on stdout by a JSON object on a line, followed by as many bytes as its `bytes` says,
/// little-endian. The model comes first:
///   {"vertices", "triangles", "bytes", "warnings"}: a float x, y, z (frame O, mm) for each vertex,
///   then three uint32 for each triangle
/// and then, for each request,
///   {"id", "bytes", "pose", "depth_mm", "coverage", "theta_clamped_share", "stretch", "seconds",
///    "warnings"}: for each vertex four floats, film_x, film_y, contact_time, stretch, as in
///   surface_map.ply: NaN where no film arrives
/// or {"id", "bytes": 0, "error": {"code", "reason", "message"}}, with the reason SUPERSEDED if a
/// newer request came before this one was done. `id` is -1 for a line that is not a request.
/// Ends with stdin.
[[nodiscard]] Verb preview_verb();

}  // namespace hydroprint::worker
