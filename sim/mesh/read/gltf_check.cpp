#include "sim/mesh/read/gltf_check.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <string>

#include "sim/base/checked_json.h"
#include "sim/mesh/read/file.h"

namespace hydroprint::mesh {
namespace {

using nlohmann::json;

constexpr int kMaxDepth = 64;

Result<std::string_view> json_text(std::string_view bytes, const std::filesystem::path& path) {
  if (!bytes.starts_with("glTF")) return bytes;
  std::array<std::uint32_t, 4> words{};  // version, length, JSON length, JSON magic
  if (bytes.size() < 20) return damaged(path, "header", "is truncated");
  std::memcpy(words.data(), bytes.data() + 4, sizeof words);
  if (words[1] > bytes.size() || words[2] > bytes.size() - 20)
    return damaged(path, "header", "announces more bytes than the file has");
  return bytes.substr(20, words[2]);
}

/// Returns a non-negative integer member; `otherwise` if there is none.
std::uint64_t number(const json& object, const char* key, std::uint64_t otherwise) {
  return json_unsigned(object, key).value_or(otherwise);
}

const json& array_of(const json& root, const char* key) {
  static const json none = json::array();
  const json& found = json_at(root, key);
  return found.is_array() ? found : none;
}

Status check_images(const json& root, const std::filesystem::path& path) {
  constexpr auto kNone = UINT64_MAX;
  const auto& views = array_of(root, "bufferViews");
  const auto& buffers = array_of(root, "buffers");
  const auto& images = array_of(root, "images");
  for (std::size_t i = 0; i < images.size(); ++i) {
    if (!images[i].is_object() || !images[i].contains("bufferView")) continue;
    const auto bad = [&] {
      return damaged(path, fmt::format("image {}", i), "lies outside its buffer");
    };
    const auto v = number(images[i], "bufferView", kNone);
    if (v >= views.size() || !views[v].is_object()) return bad();
    const auto b = number(views[v], "buffer", kNone);
    if (b >= buffers.size() || !buffers[b].is_object()) return bad();
    const auto size = number(buffers[b], "byteLength", 0);
    const auto offset = number(views[v], "byteOffset", 0);
    const auto length = number(views[v], "byteLength", 0);
    if (length == 0 || offset > size || length > size - offset) return bad();
  }
  return {};
}

Status check_extensions(const json& root, const std::filesystem::path& path) {
  for (const auto& entry : array_of(root, "extensionsRequired")) {
    const std::string name = entry.is_string() ? entry.get<std::string>() : "?";
    if (name == "KHR_texture_transform" || name == "KHR_mesh_quantization" ||
        name.starts_with("KHR_materials_") || name == "KHR_lights_punctual")
      continue;
    return bad_input(path, "extensionsRequired",
                     "needs " + name +
                         ", which is not supported; export without this extension, "
                         "for example without compression");
  }
  return {};
}

}  // namespace

Status check_gltf(std::string_view bytes, const std::filesystem::path& path) {
  HP_ASSIGN_OR_RETURN(const std::string_view text, json_text(bytes, path));
  const auto root = parse_json(text, {text.size(), kMaxDepth});
  if (!root) return bad_input(path, "", "JSON: " + root.error().message);
  if (!root->is_object()) return damaged(path, "", "is not valid glTF JSON");
  HP_RETURN_IF_ERROR(check_extensions(*root, path));
  return check_images(*root, path);
}

}  // namespace hydroprint::mesh
