#include "sim/sample/sample.h"

#include <array>
#include <span>
#include <system_error>

#include "sim/base/artifact_file.h"
#include "sim/image/io/image_file.h"
#include "sim/image/io/png.h"
#include "sim/sample/textured_mesh.h"

namespace hydroprint::sample {
namespace {

struct Maker {
  const char* name;
  const char* description;
  Sample (*make)();
};

constexpr std::array kMakers = {
    Maker{"globe", "a globe of radius 60 mm with continents, graticule and marked poles",
          make_globe},
    Maker{"sphere80", "a sphere of radius 80 mm with a chessboard of 15-degree squares",
          make_sphere80},
    Maker{"board", "a board of 120 x 120 x 10 mm with grid lines every 10 and 2 mm", make_board},
    Maker{"ubend", "a U-shaped tube with a chessboard, its two feet dipped first", make_ubend},
    Maker{"mug", "a mug with handle and cavity and a picture wrapped around it", make_mug},
    Maker{"bowl",
          "a deep bowl with a chessboard; no film can cover its inside (Fig. 17 of the paper)",
          make_bowl}};

std::span<const unsigned char> bytes_of(const std::string& text) {
  return {reinterpret_cast<const unsigned char*>(text.data()), text.size()};
}

Status write(const Sample& sample, const std::string& name, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    return fail(Code::kPermissionDenied, folder.string() + ": cannot be created (" +
                                             error.message() + "). Choose another folder");
  const std::string material = "newmtl " + name + "\nKd 1 1 1\nmap_Kd " + name + ".png\n";
  HP_RETURN_IF_ERROR(
      image::write_png(folder / (name + ".png"), sample.texture, 25.4 * sample.px_per_mm));
  HP_RETURN_IF_ERROR(image::write_artifact(folder / (name + ".mtl"), bytes_of(material)));
  return image::write_artifact(folder / (name + ".obj"), bytes_of(sample.mesh.to_obj(name)));
}

Result<Sample> make(const std::string& kind) {
  std::string known;
  for (const auto& maker : kMakers) {
    if (kind == maker.name) return maker.make();
    known.append(known.empty() ? "" : ", ").append(maker.name);
  }
  return fail(Code::kInvalidArgument, "unknown sample \"" + kind + "\". Choose one of " + known);
}

}  // namespace

std::vector<SampleKind> kinds() {
  std::vector<SampleKind> result;
  for (const auto& maker : kMakers) result.push_back({maker.name, maker.description});
  return result;
}

Status write_sample(const std::string& kind, const std::filesystem::path& folder) {
  HP_ASSIGN_OR_RETURN(const Sample sample, make(kind));
  return write(sample, kind, folder);
}

Result<mesh::Model> make_model(const std::string& kind) {
  HP_ASSIGN_OR_RETURN(const Sample sample, make(kind));
  mesh::Model model = sample.mesh.to_model();
  model.path = kind;
  mesh::Material material;
  material.name = kind;
  material.has_colour = true;
  HP_ASSIGN_OR_RETURN(material.texture_bytes,
                      image::encode_png(sample.texture, 25.4 * sample.px_per_mm));
  model.materials = {std::move(material)};
  model.triangle_material.assign(model.triangles.size(), 0);
  return model;
}

}  // namespace hydroprint::sample
