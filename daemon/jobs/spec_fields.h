#pragma once

#include <string>

#include "daemon/platform/resource_names.h"
#include "hydroprint/v1/spec.pb.h"
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

/// Checks that the extra files contain the file of a polygon film.
template <class Spec>
[[nodiscard]] Status check_polygon(const std::string& kind, const Spec& spec) {
  if (!spec.film().starts_with("polygon:")) return {};
  for (const v1::InputFile& file : spec.extra_files()) {
    if (spec.film() == "polygon:" + file.name()) return {};
  }
  return invalid_field(kind + ".film",
                       "names a polygon whose file is not in extra_files; add the file there");
}

/// Checks that inertia is used only with the sheet model.
template <class Spec>
[[nodiscard]] Status check_inertia(const std::string& kind, const Spec& spec) {
  if (!spec.inertia() || spec.model() != v1::MODEL_STOKES) return {};
  return invalid_field(
      kind + ".inertia",
      "Stokes flow has no inertia; leave this field out, or set the model to sheet");
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
