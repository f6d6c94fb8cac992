#pragma once

#include "sim/worker/common/verb.h"

namespace hydroprint::worker {

/// Reads the model once and answers each request with an approximate dip (pipeline::preview_of),
/// for a page on which the user turns the object. Its spec is that of simulate; texture, resolution
/// and film model are ignored.
///
/// Each request is a JSON object on a line of stdin:
///   {"id": 7, "pose": {"rotation_wxyz": [1, 0, 0, 0], "translation_mm": [0, 0, 0]}, "film": "A3",
///    "depth_mm": 30, "dip_speed_mm_per_s": 5}
/// Only `id` (a whole number) is required; the other keys default to the command line's values.
/// Each answer on stdout is a JSON object on a line, followed by `bytes` bytes of little-endian
/// data. The first answer is the model:
///   {"vertices", "triangles", "bytes", "warnings"}: a float x, y, z (frame O, mm) for each vertex,
///   then three uint32 for each triangle
/// Each request is answered by
///   {"id", "bytes", "pose", "depth_mm", "coverage", "theta_clamped_share", "stretch", "seconds",
///    "warnings"}: for each vertex four floats, film_x, film_y, contact_time, stretch, as in
///   surface_map.ply: NaN where no film arrives
/// or by {"id", "bytes": 0, "error": {"code", "reason", "message"}}, with the reason SUPERSEDED if
/// a newer request came before this one was done. `id` is -1 for a line that is not a request.
/// The program ends at the end of stdin.
[[nodiscard]] Verb preview_verb();

}  // namespace hydroprint::worker
