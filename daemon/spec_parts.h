#pragma once

#include <string>
#include <vector>

#include "daemon/work_builder.h"

namespace hydroprint::v1 {
class Pose;
}

namespace hydroprint::daemon {

// Parts that the specs of several jobs have in common, each checked and put into a WorkBuilder. A
// `Spec` is a message of proto/hydroprint/v1/spec.proto that has the fields of the part.

constexpr int kMostExtraFiles = 256;

void add_pose(WorkBuilder& builder, const v1::Pose& pose);
/// A film that is given. A polygon must be among the files already.
void add_film(WorkBuilder& builder, const std::string& film);
void add_threads(WorkBuilder& builder, std::int32_t threads, NewJob& made);
void add_dpi(WorkBuilder& builder, double dpi);
/// A flag with names made of letters and a joint ("-" or "_"), which the worker knows or refuses.
void add_names(WorkBuilder& builder, const std::string& field,
               const std::vector<std::string>& given, char joint);

template <class Spec>
void add_extra_files(WorkBuilder& builder, const Spec& spec) {
  if (spec.extra_files_size() > kMostExtraFiles) {
    builder.refuse("extra_files", "has more than 256 files");
    return;
  }
  for (const v1::InputFile& file : spec.extra_files()) builder.file("extra_files", "", file);
}

template <class Spec>
void add_film_image(WorkBuilder& builder, const Spec& spec) {
  if (!spec.has_film_image()) {
    builder.refuse("film_image", "is missing");
    return;
  }
  builder.file("film_image", "film-image", spec.film_image());
}

/// An object as it is held over its film.
template <class Spec>
void add_object(WorkBuilder& builder, const Spec& spec) {
  if (!spec.has_mesh()) builder.refuse("mesh", "is missing");
  if (spec.has_mesh()) builder.file("mesh", "mesh", spec.mesh());
  add_extra_files(builder, spec);
  if (spec.has_scale()) builder.number("scale", "scale", spec.scale(), 1e9);
  if (spec.has_pose()) add_pose(builder, spec.pose());
  if (spec.has_film()) add_film(builder, spec.film());
}

}  // namespace hydroprint::daemon
