#include "proto/model_summary_text.h"

#include <fmt/format.h>

#include <string_view>

#include "hydroprint/v1/report.pb.h"
#include "sim/base/number_text.h"
#include "sim/base/utf8.h"

namespace hydroprint {
namespace {

using v1::ModelSummary;

std::string size_text(const ModelSummary& summary) {
  std::string out;
  for (int axis = 0; axis < summary.lowest_mm_size(); ++axis) {
    out += axis == 0 ? "" : " x ";
    out += three_digits(summary.highest_mm(axis) - summary.lowest_mm(axis));
  }
  return out;
}

std::string texture_text(const ModelSummary::Material& material) {
  return fmt::format("{}, {} x {} px",
                     material.texture().empty() ? "texture in the file"
                                                : "texture " + one_line(material.texture()),
                     material.texture_width_px(), material.texture_height_px());
}

std::string source_text(const ModelSummary::Material& material, int source) {
  switch (source) {
    case ModelSummary::TEXTURE:
      return texture_text(material);
    case ModelSummary::MATERIAL_COLOUR:
      return material.colour();
    case ModelSummary::VERTEX_COLOURS:
      return "colours of the vertices";
    case ModelSummary::TRIANGLE_COLOURS:
      return "colours of the triangles";
    default:
      return "unknown";
  }
}

std::string material_text(const ModelSummary::Material& material) {
  std::string sources;
  for (const int source : material.colour_sources())
    sources += (sources.empty() ? "" : ", times ") + source_text(material, source);
  return fmt::format("{}, {} triangles: {}\n",
                     material.name().empty() ? std::string("without material")
                                             : "material \"" + one_line(material.name()) + "\"",
                     material.triangles(), sources.empty() ? "no colour, stays white" : sources);
}

}  // namespace

std::string model_summary_text(const ModelSummary& summary) {
  std::string out = fmt::format("{}, {} vertices, {} triangles, {}\n", summary.format(),
                                summary.vertices(), summary.triangles(),
                                summary.has_texture_coordinates() ? "with texture coordinates"
                                                                  : "without texture coordinates");
  out +=
      fmt::format("size {} mm at scale {}\n", size_text(summary), shortest_text(summary.scale()));
  if (summary.has_likely_unit()) {
    out += fmt::format("unusual size; the file may be in {}: --scale {}\n",
                       summary.likely_unit().name(), shortest_text(summary.likely_unit().mm()));
  }
  for (const ModelSummary::Material& material : summary.materials()) out += material_text(material);
  for (const ModelSummary::Companion& companion : summary.companions()) {
    out += fmt::format("file {}: {}\n", one_line(companion.name()),
                       companion.is_missing() ? "missing" : "found");
  }
  for (const std::string& phrase : summary.not_understood())
    out += fmt::format("not understood: {}\n", one_line(phrase));
  if (summary.shown_triangles() < summary.triangles())
    out += fmt::format("shown with {} triangles\n", summary.shown_triangles());
  return out;
}

}  // namespace hydroprint
