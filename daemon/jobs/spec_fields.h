#pragma once

#include <string>

#include "daemon/platform/resource_names.h"
#include "daemon/rest/bad_request.h"
#include "hydroprint/v1/spec.pb.h"
#include "proto/paint/check_paint.h"
#include "sim/print/settings.h"

namespace hydroprint::daemon {

// Checks that several kinds share, for fields that depend on each other; the rules of single fields
// are in the .proto file. `Spec` is a message of proto/hydroprint/v1/spec.proto that has these
// fields. `kind` is the name of the kind's field in Job ("print_image"), for errors.

using InputFiles = google::protobuf::RepeatedPtrField<v1::InputFile>;

/// Checks that there are 1 to `most_views` views: folders with frames.json, as hydroprint-capture
/// writes them.
[[nodiscard]] Status check_frames(const std::string& kind, const InputFiles& frames,
                                  int most_views);
/// Returns the number of views: of folders with frames.json.
[[nodiscard]] int count_views(const InputFiles& frames);

/// Checks that a polygon film's file is among the extra files.
/// @param path  of the message that has the film, for errors: "simulate", "plan.film"
template <class Film>
[[nodiscard]] Status check_polygon(const std::string& path, const Film& film,
                                   const InputFiles& extra_files) {
  if (!film.film().starts_with("polygon:")) return {};
  for (const v1::InputFile& file : extra_files) {
    if (film.film() == "polygon:" + file.name()) return {};
  }
  return invalid_field(path + ".film",
                       "names a polygon whose file is not in extra_files; add the file there");
}
template <class Spec>
[[nodiscard]] Status check_polygon(const std::string& kind, const Spec& spec) {
  return check_polygon(kind, spec, spec.extra_files());
}

/// Checks that inertia is used only with the sheet model.
/// @param path  of the message that has the model: see check_polygon()
template <class Film>
[[nodiscard]] Status check_inertia(const std::string& path, const Film& film) {
  if (!film.inertia() || film.model() != v1::MODEL_STOKES) return {};
  return invalid_field(
      path + ".inertia",
      "Stokes flow has no inertia; leave this field out, or set the model to sheet");
}

/// Checks the paint of an object, and the short forms of one.
/// @param path  of the message that has them, for errors: "simulate", "plan.object"
template <class Object>
[[nodiscard]] Status check_paint(const std::string& path, const Object& object) {
  const auto violations = paint::check_fields_of(object, path);
  if (violations.empty()) return {};
  return tl::unexpected(rest::bad_request(violations));
}

/// Checks that the margins leave space for printing.
template <class Spec>
[[nodiscard]] Status check_margin(const std::string& kind, const Spec& spec) {
  print::PageSettings page;
  if (spec.has_paper()) {
    HP_ASSIGN_OR_RETURN(page.paper_mm, print::parse_paper(spec.paper()));
  }
  page.printer_margin_mm = spec.printer_margin_mm();
  const Status fits = print::check(page);
  if (fits) return {};
  return invalid_field(kind + ".printer_margin_mm", fits.error().message);
}

}  // namespace hydroprint::daemon
