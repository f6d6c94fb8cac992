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
/// data. Each request is answered by
///   {"id", "bytes", "pose", "depth_mm", "coverage", "theta_clamped_share", "stretch", "seconds",
///    "warnings"}, each of the latter a v1::Warning: for each place of the model that is shown
///    (display::shown_shape()) four floats,
///   film_x, film_y, contact_time, stretch, as in surface_map.ply: NaN where no film arrives
/// or by {"id", "bytes": 0, "error": Failure}, with the reason PREVIEW_SUPERSEDED if
/// a newer request came before this one was done, and INPUT_REFUSED if the model's colours cannot
/// be read. The request {"id": 7, "read": true} (and "shape_only": true, as in InspectSpec) is
/// answered by the model for display, with the binary glTF of inspect_model() as bytes:
///   {"id", "bytes", "summary"}, the latter a v1::ModelSummary
/// `id` is -1 for a line that is not a request.
/// The program ends at the end of stdin.
[[nodiscard]] Verb preview_verb();

}  // namespace hydroprint::worker
