#pragma once

#include <map>
#include <string>

#include "tests/sim/mesh/files.h"

namespace hydroprint::mesh {

inline std::string base64(const std::string& bytes) {
  static const char* const kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (int k = 3; k >= 0; --k) text += kDigits[group >> (6 * k) & 63];
  }
  for (std::size_t k = bytes.size() % 3; k > 0 && k < 3; ++k) text[text.size() - 3 + k] = '=';
  return text;
}

/// Buffer of the tetrahedron: positions, then indices (the first one is replaced by `first`), then
/// texture coordinates.
inline std::string tetrahedron_buffer(int first = 0) {
  std::string bytes;
  for (const auto& corner : kCorners)
    for (const float c : corner) put(bytes, c);
  bool is_first = true;
  for (const auto& face : kTetrahedron)
    for (const int corner : face) {
      put<std::uint16_t>(bytes, static_cast<std::uint16_t>(is_first ? first : corner));
      is_first = false;
    }
  for (int i = 0; i < 4; ++i) {
    put(bytes, i == 1 ? 1.0F : 0.0F);
    put(bytes, 0.25F);
  }
  return bytes;
}

/// glTF JSON of the tetrahedron. `parts` replaces the parts that a test changes.
inline std::string tetrahedron_gltf(const std::map<std::string, std::string>& parts = {}) {
  const auto part = [&](const std::string& key, const std::string& otherwise) {
    return parts.count(key) != 0 ? parts.at(key) : otherwise;
  };
  const std::string buffer = tetrahedron_buffer(std::stoi(part("index", "0")));
  std::string uri = part("uri", "data:application/octet-stream;base64," + base64(buffer));
  if (!uri.empty()) uri = ",\"uri\":\"" + uri + "\"";
  std::string views = R"(,"bufferViews":[{"buffer":0,"byteLength":)" + part("viewLength", "48") +
                      R"(},{"buffer":0,"byteOffset":48,"byteLength":24},)" +
                      R"({"buffer":0,"byteOffset":72,"byteLength":32}])";
  const std::string extra = part("extra", "");
  if (extra.find("bufferViews") != std::string::npos) views.clear();
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":)" +
         part("nodes", R"([{"mesh":0}])") +
         R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":)" + part("attribute", "0") +
         part("attributes", "") + R"(},"indices":1)" + part("material", "") +
         R"(}]}],"accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","byteOffset":)" +
         part("offset", "0") + R"(,"count":)" + part("count", "4") +
         R"(},{"bufferView":1,"componentType":5123,"type":"SCALAR","count":)" +
         part("indexCount", "12") +
         R"(},{"bufferView":2,"componentType":5126,"type":"VEC2","count":4}],"buffers":[{"byteLength":)" +
         std::to_string(buffer.size()) + uri + "}]" + views + extra + "}";
}

inline std::string textured_gltf(const std::string& picture = "picture") {
  return tetrahedron_gltf(
      {{"attributes", ",\"TEXCOORD_0\":2"},
       {"material", ",\"material\":0"},
       {"extra", R"(,"materials":[{"pbrMetallicRoughness":{"baseColorFactor":[1,0.5,0,1],
         "baseColorTexture":{"index":0}}}],"textures":[{"source":0,"sampler":0}],
         "samplers":[{"wrapS":33071,"wrapT":33648}],
         "images":[{"uri":"data:image/png;base64,)" +
                     base64(picture) + "\"}]"}});
}

inline std::string tetrahedron_glb() {
  std::string json = tetrahedron_gltf({{"uri", ""}});
  json.append((4 - json.size() % 4) % 4, ' ');
  const std::string buffer = tetrahedron_buffer();
  std::string bytes = "glTF";
  put<std::uint32_t>(bytes, 2);
  put<std::uint32_t>(bytes, static_cast<std::uint32_t>(28 + json.size() + buffer.size()));
  put<std::uint32_t>(bytes, static_cast<std::uint32_t>(json.size()));
  put<std::uint32_t>(bytes, 0x4E4F534A);
  bytes += json;
  put<std::uint32_t>(bytes, static_cast<std::uint32_t>(buffer.size()));
  put<std::uint32_t>(bytes, 0x004E4942);
  return bytes + buffer;
}

}  // namespace hydroprint::mesh
