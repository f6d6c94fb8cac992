#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <exception>
#include <iterator>
#include <map>
#include <new>
#include <set>
#include <streambuf>

#include "sim/mesh/read/colours.h"
#include "sim/mesh/read/file.h"
#include "sim/mesh/read/mtl.h"
#include "sim/mesh/read/names.h"
#include "sim/mesh/read/numbers.h"
#include "sim/mesh/read/obj_check.h"
#include "sim/mesh/read/readers.h"
#include "sim/mesh/read/triangulate.h"

namespace hydroprint::mesh {
namespace {

/// Lets the importer read from memory without a copy.
class MemoryBuffer : public std::streambuf {
 public:
  explicit MemoryBuffer(std::string& text) {
    setg(text.data(), text.data(), text.data() + text.size());
  }
};

/// Joins lines that continue after a backslash, because the importer does not support them.
void join_continued_lines(std::string& text) {
  for (auto at = text.find('\\'); at != text.npos; at = text.find('\\', at + 1)) {
    const auto end = text.compare(at + 1, 2, "\r\n") == 0 ? at + 3
                     : text.compare(at + 1, 1, "\n") == 0 ? at + 2
                                                          : at;
    for (auto i = at; i < end; ++i) text[i] = ' ';
  }
}

/// Replaces comments after faces with blanks, because the importer would read them as more corners.
void blank_face_comments(std::string& text) {
  for (auto at = text.find('#'); at != text.npos; at = text.find('#', at)) {
    const auto begin = text.find_last_of("\r\n", at) + 1;  // npos + 1 is 0: the first line
    const auto end = std::min(text.find_first_of("\r\n", at), text.size());
    std::string_view before(text.data() + begin, at - begin);
    if (next_word(before) == "f") text.replace(at, end - at, end - at, ' ');
    at = end;
  }
}

/// Adds a blank to lines of `usemtl` alone, which the importer would otherwise ignore.
void lengthen_bare_usemtl(std::string& text) {
  constexpr std::string_view kWord = "usemtl";
  for (auto at = text.find(kWord); at != text.npos; at = text.find(kWord, at + 1)) {
    const auto end = at + kWord.size();
    if (end == text.size() || text[end] == '\n' || text[end] == '\r') text.insert(end, 1, ' ');
  }
}

/// The materials of the files that a model names, by their names.
struct Library {
  std::map<std::string, MtlMaterial> by_name;
  std::map<std::string, std::vector<std::string>> names_by_key;  ///< keys of name_key()
  std::map<std::string, std::filesystem::path> folder_of;
};

class ObjImporter {
 public:
  ObjImporter(const std::filesystem::path& path, ObjFacts facts) : facts_(std::move(facts)) {
    model_.path = path;
    model_.vertices.reserve(facts_.vertices);
    model_.triangles.reserve(facts_.triangles);
  }

  Result<Model> run(std::string& text) {
    for (const auto& line : facts_.libraries) HP_RETURN_IF_ERROR(read_library(line));
    tinyobj::callback_t callback;
    callback.vertex_cb = [](void* self, double x, double y, double z, double) {
      cast(self).model_.vertices.emplace_back(x, y, z);
    };
    callback.texcoord_cb = [](void* self, double u, double v, double) {
      cast(self).uvs_.emplace_back(static_cast<float>(u), static_cast<float>(v));
    };
    callback.index_cb = [](void* self, tinyobj::index_t* indices, int count) {
      cast(self).keep_face({indices, static_cast<std::size_t>(count)});
    };
    callback.usemtl_cb = [](void* self, const char* name, int) { cast(self).use(name); };
    MemoryBuffer buffer(text);
    std::istream stream(&buffer);
    if (!tinyobj::LoadObjWithCallback(stream, callback, this) ||
        model_.vertices.size() != facts_.vertices || uvs_.size() != facts_.texture_coordinates)
      return damaged(model_.path, "", "could not be read completely");
    add_faces();
    finish();
    return std::move(model_);
  }

 private:
  static ObjImporter& cast(void* self) { return *static_cast<ObjImporter*>(self); }

  void warn(WarningCode code, std::string message) {
    model_.warnings.push_back({code, std::move(message), {InFile{model_.path.string()}}});
  }

  Status read_library(const std::string& line) {
    const auto folder = model_.path.parent_path();
    std::vector<std::filesystem::path> candidates = {resolve_texture(folder, line)};
    if (candidates.front().empty()) return {};
    std::string_view rest = line;
    for (auto word = next_word(rest); !word.empty(); word = next_word(rest))
      candidates.push_back(folder / word);
    bool found = false;
    std::error_code error;
    for (const auto& candidate : candidates) {
      if (!std::filesystem::is_regular_file(candidate, error)) continue;
      HP_RETURN_IF_ERROR(read_materials(candidate));
      found = true;
      if (&candidate == &candidates.front()) break;  // the whole line is one name
    }
    if (found) return {};
    const auto& missing = candidates.front();
    if (const auto similar = similar_file(missing, folder)) {
      model_.warnings.push_back(similar_name(missing, *similar, model_.path));
      return read_materials(*similar);
    }
    missing_files_.push_back(trimmed(line));
    return {};
  }

  Status read_materials(const std::filesystem::path& path) {
    std::error_code error;
    if (std::filesystem::file_size(path, error) == 0 && !error) return {};
    HP_ASSIGN_OR_RETURN(std::string text, read_file(path));
    HP_ASSIGN_OR_RETURN(MtlFile file, parse_mtl(without_byte_order_mark(text), path));
    model_.material_files.push_back({path, false});
    for (auto& material : file.materials) {
      library_.folder_of.try_emplace(material.name, path.parent_path());
      library_.names_by_key[name_key(material.name)].push_back(material.name);
      library_.by_name.try_emplace(material.name, material);
    }
    std::ranges::move(file.warnings, std::back_inserter(model_.warnings));
    return {};
  }

  void use(const std::string& written) {
    const std::string name = trimmed(written);
    if (name.empty()) {  // as Blender writes it for faces without a material
      current_ = -1;
      return;
    }
    const auto known = used_.find(name);
    if (known != used_.end()) {
      current_ = known->second;
      return;
    }
    current_ = static_cast<int>(model_.materials.size());
    used_.emplace(name, current_);
    add_material(name);
  }

  /// Returns the material of this name, or the only one whose name differs in case or Unicode form.
  const MtlMaterial* find(const std::string& name) {
    const auto exact = library_.by_name.find(name);
    if (exact != library_.by_name.end()) return &exact->second;
    const auto similar = library_.names_by_key.find(name_key(name));
    if (similar == library_.names_by_key.end()) return nullptr;
    const std::set<std::string> names(similar->second.begin(), similar->second.end());
    if (names.size() != 1) return nullptr;
    warn(WarningCode::SIMILAR_NAME,
         fmt::format("the material \"{}\" was taken for \"{}\", which is not defined",
                     *names.begin(), name));
    return &library_.by_name.at(*names.begin());
  }

  /// Appends the material as defined in the files; one without colour if it is not defined.
  void add_material(const std::string& name) {
    Material material;
    material.name = name;
    Transform transform;
    if (const MtlMaterial* found = find(name)) {
      material.has_colour = found->colour.has_value();
      material.colour = found->colour.value_or(Eigen::Vector3f::Ones());
      if (!found->texture.empty()) {
        material.texture = resolve_texture(library_.folder_of.at(found->name), found->texture);
        material.wrap_u = material.wrap_v = found->wrap;
        transform = {found->scale, found->offset};
      }
      for (const std::string& what : found->not_understood)
        model_.not_understood.push_back(fmt::format("material \"{}\": {}", name, what));
    } else {
      missing_.insert(name);
    }
    model_.materials.push_back(std::move(material));
    transforms_.push_back(transform);
  }

  /// Corners may precede their vertices in the file, so faces are resolved at the end.
  void keep_face(std::span<const tinyobj::index_t> corners) {
    const auto resolve = [](int index, std::size_t count) {
      return index < 0 ? static_cast<int>(count) + index : index - 1;
    };
    for (const auto& corner : corners) {
      corners_.push_back(resolve(corner.vertex_index, model_.vertices.size()));
      corner_uvs_.push_back(resolve(corner.texcoord_index, uvs_.size()));
    }
    face_end_.push_back(corners_.size());
    face_material_.push_back(current_);
  }

  void add_faces() {
    std::size_t begin = 0;
    for (std::size_t f = 0; f < face_end_.size(); ++f) {
      const auto polygon = std::span(corners_).subspan(begin, face_end_[f] - begin);
      for (const auto& t : triangulate(model_.vertices, polygon)) {
        model_.triangles.emplace_back(polygon[static_cast<std::size_t>(t[0])],
                                      polygon[static_cast<std::size_t>(t[1])],
                                      polygon[static_cast<std::size_t>(t[2])]);
        add_uvs(begin, t, face_material_[f]);
        model_.triangle_material.push_back(face_material_[f]);
      }
      begin = face_end_[f];
    }
  }

  void add_uvs(std::size_t begin, const std::array<int, 3>& triangle, int material) {
    std::array<Eigen::Vector2f, 3> uvs;
    bool complete = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const int index = corner_uvs_[begin + static_cast<std::size_t>(triangle[k])];
      complete = complete && index >= 0;
      uvs[k] = index < 0 ? Eigen::Vector2f::Zero() : uvs_[static_cast<std::size_t>(index)];
      if (material < 0) continue;
      const auto& transform = transforms_[static_cast<std::size_t>(material)];
      uvs[k] = uvs[k].cwiseProduct(transform.scale) + transform.offset;
    }
    if (!complete) ++without_uvs_;
    model_.corner_uvs.push_back(uvs);
  }

  void finish() {
    if (without_uvs_ == model_.triangles.size())
      model_.corner_uvs.clear();
    else if (without_uvs_ > 0)
      warn(WarningCode::FACES_WITHOUT_UV,
           fmt::format("{} faces have no texture coordinates: they take the "
                       "colour of the texture's lower left corner",
                       without_uvs_));
    if (model_.materials.empty())
      model_.triangle_material.clear();
    else
      add_default_material();
    take_vertex_colours();
    warn_of_materials();
  }

  void take_vertex_colours() {
    bring_to_unit(facts_.vertex_colours, "vertices", model_.path, model_.warnings);
    if (facts_.coloured_vertices > 0 && facts_.coloured_vertices < facts_.vertices)
      warn(WarningCode::VERTEX_COLOURS_IN_PART,
           fmt::format("only {} of {} vertices have colours: the others are white",
                       facts_.coloured_vertices, facts_.vertices));
    model_.vertex_colours = std::move(facts_.vertex_colours);
    for (std::string& what : facts_.not_understood)
      model_.not_understood.push_back(std::move(what));
  }

  /// A missing file or material is reported if a face needs it.
  void warn_of_materials() {
    if (missing_.empty() || !model_.vertex_colours.empty()) {
      if (!missing_files_.empty())
        warn(WarningCode::MATERIAL_FILE_UNUSED,
             fmt::format("the material file {} was not found; no face needs it",
                         missing_files_.front()));
    } else if (!missing_files_.empty()) {
      for (const std::string& name : missing_files_)
        model_.material_files.push_back({model_.path.parent_path() / name, true});
      warn(
          WarningCode::MATERIAL_FILE_MISSING,
          fmt::format("the material file {} was not found, so its colours and textures are missing",
                      missing_files_.front()));
    } else {
      warn(WarningCode::MATERIAL_MISSING,
           "material \"" + *missing_.begin() +
               "\" is not defined in the material file, so its faces have no colour");
    }
  }

  void add_default_material() {
    bool needed = false;
    for (auto& material : model_.triangle_material) {
      if (material >= 0) continue;
      needed = true;
      material = static_cast<int>(model_.materials.size());
    }
    if (needed) model_.materials.emplace_back();
  }

  struct Transform {
    Eigen::Vector2f scale = {1, 1};
    Eigen::Vector2f offset = {0, 0};
  };

  ObjFacts facts_;
  Model model_;
  Library library_;
  std::vector<std::string> missing_files_;
  std::map<std::string, int> used_;
  std::set<std::string> missing_;
  std::vector<Transform> transforms_;  ///< texture transform of each material
  std::vector<Eigen::Vector2f> uvs_;
  std::vector<int> corners_;
  std::vector<int> corner_uvs_;  ///< index into uvs_ for each corner; -1: none
  std::vector<std::size_t> face_end_;
  std::vector<int> face_material_;
  int current_ = -1;
  std::size_t without_uvs_ = 0;
};

}  // namespace

Result<Model> read_obj(std::string bytes, const std::filesystem::path& path,
                       const Context& context) try {
  bytes = without_byte_order_mark(std::move(bytes));
  join_continued_lines(bytes);
  blank_face_comments(bytes);
  HP_ASSIGN_OR_RETURN(ObjFacts facts, check_obj(bytes, path, context));
  HP_RETURN_IF_ERROR(check_face_count(facts.triangles, path));
  if (facts.has_bare_usemtl) lengthen_bare_usemtl(bytes);
  return ObjImporter(path, std::move(facts)).run(bytes);
} catch (const std::bad_alloc&) {
  throw;  // not a fault of the file
} catch (const std::exception& e) {
  return bad_input(path, "", e.what());
}

}  // namespace hydroprint::mesh
