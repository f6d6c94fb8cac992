#include "hardware/simulator/scene/codec.h"

#include "sim/base/checked_json.h"

namespace hydroprint::simulated_scene {
namespace {

using nlohmann::json;

// Limits the text to 1 GiB, because a scene may have millions of triangles.
constexpr JsonLimits kLimits{std::size_t{1} << 30};

json array_of(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Eigen::Vector3d vector_of(const json& from) {
  return {from.at(0).get<double>(), from.at(1).get<double>(), from.at(2).get<double>()};
}

json json_of(const Body& body) {
  json points = json::array();
  for (const Eigen::Vector3d& p : body.mesh.points) {
    for (const double x : p) points.push_back(x);
  }
  json triangles = json::array();
  for (const Eigen::Vector3i& t : body.mesh.triangles) {
    for (const int i : t) triangles.push_back(i);
  }
  return {{"name", body.name}, {"hangs", body.hangs}, {"points", points}, {"triangles", triangles}};
}

/// Decodes a body. Throws an exception of the JSON library if a field is missing or invalid.
Body body_of(const json& from) {
  Body out{from.at("name"), {}, from.at("hangs")};
  const json& points = from.at("points");
  for (std::size_t i = 0; i < points.size(); i += 3) {
    out.mesh.points.emplace_back(points.at(i), points.at(i + 1), points.at(i + 2));
  }
  const json& triangles = from.at("triangles");
  for (std::size_t i = 0; i < triangles.size(); i += 3) {
    const Eigen::Vector3i t(triangles.at(i), triangles.at(i + 1), triangles.at(i + 2));
    for (const int corner : t) (void)points.at(3 * static_cast<std::size_t>(corner));
    out.mesh.triangles.push_back(t);
  }
  return out;
}

json json_of(const CameraStand& stand) {
  json via = json::array();
  for (const Eigen::Vector3d& place : stand.via_mm) via.push_back(array_of(place));
  return {{"at_mm", array_of(stand.at_mm)}, {"looks_at_mm", array_of(stand.looks_at_mm)},
          {"turn_rad", stand.turn_rad},     {"via_mm", via},
          {"period_s", stand.period_s},     {"trembles", stand.trembles}};
}

CameraStand stand_of(const json& from) {
  CameraStand out{vector_of(from.at("at_mm")), vector_of(from.at("looks_at_mm")),
                  from.at("turn_rad"),         {},
                  from.at("period_s"),         from.at("trembles")};
  for (const json& place : from.at("via_mm")) out.via_mm.push_back(vector_of(place));
  return out;
}

/// Returns the state named by a word of the list; throws like body_of for an unknown word.
template <class State, std::size_t N>
State state_of(const std::string_view (&words)[N], const json& from) {
  const auto word = from.get<std::string>();
  for (std::size_t i = 0; i < N; ++i) {
    if (words[i] == word) return static_cast<State>(i);
  }
  (void)json::object().at(word);  // throws
  return {};
}

template <class Value, class Read>
Result<Value> guarded(std::string_view text, const Read& read) {
  try {
    return read(parse_json(text, kLimits).value_or(nullptr));
  } catch (const json::exception&) {
    return fail(Code::kDataLoss,
                "the virtual rig's scene cannot be decoded. Use a rig and a driver of the same "
                "build");
  }
}

}  // namespace

std::string to_json(const Scenery& scenery) {
  json bodies = json::array();
  for (const Body& body : scenery.bodies) bodies.push_back(json_of(body));
  json markers = json::array();
  for (const Marker& marker : scenery.markers) {
    markers.push_back(
        {{"name", marker.name}, {"at_mm", array_of(marker.at_mm)}, {"turn_rad", marker.turn_rad}});
  }
  return json{{"bodies", bodies},
              {"markers", markers},
              {"stand", json_of(scenery.stand)},
              {"seed", scenery.seed},
              {"has_errors", scenery.has_errors},
              {"counts_frames", scenery.counts_frames}}
      .dump();
}

Result<Scenery> scenery_of(std::string_view text) {
  return guarded<Scenery>(text, [](const json& from) {
    Scenery out;
    for (const json& body : from.at("bodies")) out.bodies.push_back(body_of(body));
    for (const json& marker : from.at("markers")) {
      out.markers.push_back(
          {marker.at("name"), vector_of(marker.at("at_mm")), marker.at("turn_rad")});
    }
    out.stand = stand_of(from.at("stand"));
    out.seed = from.at("seed");
    out.has_errors = from.at("has_errors");
    out.counts_frames = from.at("counts_frames");
    return out;
  });
}

std::string to_json(const Sight& sight) {
  json markers = json::array();
  for (const MarkerState state : sight.markers) {
    markers.push_back(kMarkerStates[static_cast<std::size_t>(state)]);
  }
  return json{{"time_s", sight.time_s},
              {"gripper_height_mm", sight.gripper_height_mm},
              {"camera", kCameraStates[static_cast<std::size_t>(sight.camera)]},
              {"markers", markers}}
      .dump();
}

Result<Sight> sight_of(std::string_view text) {
  return guarded<Sight>(text, [](const json& from) {
    Sight out;
    out.time_s = from.at("time_s");
    out.gripper_height_mm = from.at("gripper_height_mm");
    out.camera = state_of<CameraState>(kCameraStates, from.at("camera"));
    for (const json& marker : from.at("markers")) {
      out.markers.push_back(state_of<MarkerState>(kMarkerStates, marker));
    }
    return out;
  });
}

}  // namespace hydroprint::simulated_scene
