#include "sim/display/glb.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "sim/base/utf8.h"

namespace hydroprint::display {
namespace {

using Json = nlohmann::ordered_json;

// Numbers of the glTF 2.0 specification.
constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;
constexpr int kUnsignedShort = 5123, kUnsignedInt = 5125, kFloat = 5126;
constexpr int kLinear = 9729, kLinearMipmapLinear = 9987;
constexpr std::uint32_t kMagic = 0x46546C67, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;

int wrap_code(mesh::Wrap wrap) {
  switch (wrap) {
    case mesh::Wrap::kClamp:
      return 33071;
    case mesh::Wrap::kMirror:
      return 33648;
    case mesh::Wrap::kRepeat:
      break;
  }
  return 10497;
}

template <class Value>
void append(std::string& bytes, Value value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::uint16_t unorm16(float value) {
  return static_cast<std::uint16_t>(std::min(std::max(value, 0.0F), 1.0F) * 65535.0F + 0.5F);
}

Json list_of(const Eigen::Vector3f& v) { return Json::array({v.x(), v.y(), v.z()}); }

/// Builds the two chunks of the file.
class Writer {
 public:
  explicit Writer(const DisplayModel& model) : model_(model) {
    json_["asset"] = {{"version", "2.0"}, {"generator", "Hydroprint"}};
    json_["extensionsUsed"] = Json::array({"KHR_materials_unlit"});
    json_["scene"] = 0;
    json_["scenes"][0]["nodes"] = Json::array({0});
  }

  Result<std::string> write(const std::string& extras) {
    if (!extras.empty()) {
      auto read = Json::parse(extras, nullptr, false);
      if (read.is_discarded()) return fail(Code::kInternal, "the extras of a model are not JSON");
      json_["asset"]["extras"] = std::move(read);
    }
    add_pictures();
    add_mesh();
    json_["buffers"][0]["byteLength"] = binary_.size();
    return container();
  }

 private:
  /// Adds the bytes since `begin` as a view, padded to a multiple of four.
  int add_view(std::size_t begin, int target) {
    Json view = {{"buffer", 0}, {"byteOffset", begin}, {"byteLength", binary_.size() - begin}};
    if (target != 0) view["target"] = target;
    json_["bufferViews"].push_back(std::move(view));
    binary_.resize((binary_.size() + 3) / 4 * 4, '\0');
    return static_cast<int>(json_["bufferViews"].size()) - 1;
  }

  int add_accessor(int view, int component, const char* type, std::size_t count) {
    json_["accessors"].push_back(
        {{"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}});
    return static_cast<int>(json_["accessors"].size()) - 1;
  }

  void add_pictures() {
    for (const Picture& picture : model_.pictures) {
      const std::size_t begin = binary_.size();
      binary_.append(reinterpret_cast<const char*>(picture.png.data()), picture.png.size());
      json_["images"].push_back({{"bufferView", add_view(begin, 0)}, {"mimeType", "image/png"}});
      json_["samplers"].push_back({{"magFilter", kLinear},
                                   {"minFilter", kLinearMipmapLinear},
                                   {"wrapS", wrap_code(picture.wrap_u)},
                                   {"wrapT", wrap_code(picture.wrap_v)}});
      const int number = static_cast<int>(json_["images"].size()) - 1;
      json_["textures"].push_back({{"sampler", number}, {"source", number}});
    }
  }

  int add_positions() {
    const std::size_t begin = binary_.size();
    Eigen::Vector3f lowest = Eigen::Vector3f::Constant(std::numeric_limits<float>::infinity());
    Eigen::Vector3f highest = -lowest;
    for (const Eigen::Vector3f& at : model_.positions) {
      for (const float x : at) append(binary_, x);
      lowest = lowest.cwiseMin(at);
      highest = highest.cwiseMax(at);
    }
    const int out =
        add_accessor(add_view(begin, kArrayBuffer), kFloat, "VEC3", model_.positions.size());
    json_["accessors"][out]["min"] = list_of(lowest);
    json_["accessors"][out]["max"] = list_of(highest);
    return out;
  }

  int add_places() {
    const std::size_t begin = binary_.size();
    // The specification allows integers of 32 bits for indices only.
    for (const int place : model_.places) append(binary_, static_cast<float>(place));
    return add_accessor(add_view(begin, kArrayBuffer), kFloat, "SCALAR", model_.places.size());
  }

  int add_uvs() {
    const std::size_t begin = binary_.size();
    for (const Eigen::Vector2f& uv : model_.uvs) {
      append(binary_, uv.x());
      append(binary_, 1 - uv.y());
    }
    return add_accessor(add_view(begin, kArrayBuffer), kFloat, "VEC2", model_.uvs.size());
  }

  int add_colours() {
    const std::size_t begin = binary_.size();
    for (const Eigen::Vector3f& colour : model_.colours) {
      for (const float c : colour) append(binary_, unorm16(c));
      append(binary_, unorm16(1));
    }
    const int out =
        add_accessor(add_view(begin, kArrayBuffer), kUnsignedShort, "VEC4", model_.colours.size());
    json_["accessors"][out]["normalized"] = true;
    return out;
  }

  int add_indices(const Part& part) {
    const std::size_t begin = binary_.size();
    for (const Eigen::Vector3i& triangle : part.triangles) {
      for (const int i : triangle) append(binary_, static_cast<std::uint32_t>(i));
    }
    return add_accessor(add_view(begin, kElementArrayBuffer), kUnsignedInt, "SCALAR",
                        3 * part.triangles.size());
  }

  int add_material(const Part& part) {
    Json surface = {{"metallicFactor", 0}, {"roughnessFactor", 1}};
    surface["baseColorFactor"] =
        Json::array({part.colour.x(), part.colour.y(), part.colour.z(), 1});
    if (part.picture >= 0) surface["baseColorTexture"]["index"] = part.picture;
    Json material = {{"name", encode_utf8(decode_utf8(part.name))},
                     {"pbrMetallicRoughness", std::move(surface)}};
    material["extensions"]["KHR_materials_unlit"] = Json::object();
    json_["materials"].push_back(std::move(material));
    return static_cast<int>(json_["materials"].size()) - 1;
  }

  void add_mesh() {
    Json attributes = {{"POSITION", add_positions()}, {"_PLACE", add_places()}};
    if (!model_.uvs.empty()) attributes["TEXCOORD_0"] = add_uvs();
    if (!model_.colours.empty()) attributes["COLOR_0"] = add_colours();
    Json primitives = Json::array();
    for (const Part& part : model_.parts) {
      primitives.push_back({{"attributes", attributes},
                            {"indices", add_indices(part)},
                            {"material", add_material(part)}});
    }
    const Eigen::Vector3d& origin = model_.origin_mm;
    json_["meshes"][0]["primitives"] = std::move(primitives);
    json_["nodes"][0] = {{"mesh", 0}};
    json_["nodes"][0]["translation"] = Json::array({origin.x(), origin.y(), origin.z()});
  }

  [[nodiscard]] Result<std::string> container() const {
    std::string text = json_.dump(-1, ' ', false, Json::error_handler_t::replace);
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::size_t length = 12 + 8 + text.size() + 8 + binary_.size();
    if (length > std::numeric_limits<std::uint32_t>::max())
      return fail(Code::kInternal, "a model for display has more than 4 GiB");
    std::string out;
    out.reserve(length);
    for (const std::size_t word :
         {std::size_t{kMagic}, std::size_t{2}, length, text.size(), std::size_t{kJsonChunk}})
      append(out, static_cast<std::uint32_t>(word));
    out += text;
    append(out, static_cast<std::uint32_t>(binary_.size()));
    append(out, kBinaryChunk);
    return out + binary_;
  }

  const DisplayModel& model_;
  Json json_;
  std::string binary_;
};

}  // namespace

Result<std::string> glb_of(const DisplayModel& model, const std::string& extras) {
  return Writer(model).write(extras);
}

}  // namespace hydroprint::display
