#pragma once

#include "sim/base/pose.h"
#include "sim/film/outline.h"
#include "sim/mesh/model.h"
#include "sim/mesh/surface.h"

namespace hydroprint::v1 {
class FilmFacts;
class MeshFacts;
class Pose;
}  // namespace hydroprint::v1

// Values that the reports of several verbs contain. For inclusion in .cpp files only.
namespace hydroprint::worker {

/// Appends numbers or texts to a field of a message.
template <class Values, class Field>
void add_all(const Values& values, Field* field) {
  field->Add(values.begin(), values.end());
}

/// Appends the entries of a matrix, row by row.
template <class Matrix, class Field>
void add_rows(const Matrix& matrix, Field* field) {
  for (const auto& row : matrix.rowwise()) add_all(row, field);
}

void set_pose(const Pose& X_FO, v1::Pose& out);
void set_film(const film::Outline& outline, v1::FilmFacts& out);
/// Sets the size of the file's mesh.
void set_mesh(const mesh::Model& model, v1::MeshFacts& out);
/// Sets the size of the surface, and whether it is closed.
void set_surface(const mesh::Surface& surface, v1::MeshFacts& out);

}  // namespace hydroprint::worker
