#include "hardware/simulator/scene/codec.h"

#include <gtest/gtest.h>

#include "hardware/simulator/scene/rig_layout.h"

namespace hydroprint::simulated_scene {
namespace {

Scenery scenery() {
  Scenery out;
  out.bodies = standing_bodies({210, 297});
  out.bodies.push_back(gripper());
  out.bodies[0].mesh.points[0].x() = 0.1 + 1e-17;
  out.markers = nominal_markers({210, 297});
  out.stand.via_mm = {{1.0 / 3, 2, 3}};
  out.seed = 0xffffffffffffffffU;
  out.counts_frames = true;
  return out;
}

TEST(Codec, DecodingGivesIdenticalValues) {
  const std::string text = to_json(scenery());
  EXPECT_EQ(text.find('\n'), std::string::npos);
  const auto back = scenery_of(text);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(to_json(*back), text);
  EXPECT_EQ(back->bodies[3].mesh.points, scenery().bodies[3].mesh.points);
  EXPECT_EQ(back->seed, scenery().seed);
  const Sight sight{1.0 / 7, -3.3, CameraState::kFrozen, {MarkerState::kKnockedOver}};
  const auto again = sight_of(to_json(sight));
  ASSERT_TRUE(again);
  EXPECT_EQ(again->time_s, sight.time_s);
  EXPECT_EQ(again->camera, sight.camera);
  EXPECT_EQ(again->markers, sight.markers);
}

TEST(Codec, OtherInputIsRefused) {
  const std::string good = to_json(scenery());
  for (std::size_t cut = 0; cut < good.size(); cut += 97) {
    EXPECT_FALSE(scenery_of(good.substr(0, cut)));
  }
  std::string wrong = good;
  wrong.replace(wrong.find("\"triangles\":[") + 13, 1, "99999");
  EXPECT_FALSE(scenery_of(wrong)) << "a triangle has a vertex index out of range";
  for (const char* text : {"", "ok", "{}", "[]", "error: no camera", "{\"time_s\":\"x\"}"}) {
    EXPECT_FALSE(sight_of(text)) << text;
    EXPECT_EQ(scenery_of(text).error().code, Code::kDataLoss);
  }
  std::string state = to_json(Sight{});
  state.replace(state.find("\"well\""), 6, "\"cross-eyed\"");
  EXPECT_FALSE(sight_of(state)) << "the state of a marker is unknown";
}

}  // namespace
}  // namespace hydroprint::simulated_scene
