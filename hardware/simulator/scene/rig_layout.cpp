#include "hardware/simulator/scene/rig_layout.h"

#include <numbers>

#include "hardware/simulator/scene/shapes.h"

namespace hydroprint::simulated_scene {
namespace {

constexpr double kBarBottom_mm = -4;
constexpr double kGap_mm = 25;  ///< between the bars and the vat's walls
constexpr double kWall_mm = 8;  ///< thickness of the vat's walls
constexpr double kRim_mm = 20;  ///< height of the vat's rim above the water
constexpr double kTable_mm = -180;
constexpr double kTableHalf_mm = 1500;

/// Returns four boxes, `width` wide, around a rectangle of half size `inner`.
Mesh frame(const Eigen::Vector2d& inner, double width, double bottom, double top) {
  const Eigen::Vector2d outer = inner.array() + width;
  return joined({box({-outer.x(), -outer.y(), bottom}, {-inner.x(), outer.y(), top}),
                 box({inner.x(), -outer.y(), bottom}, {outer.x(), outer.y(), top}),
                 box({-inner.x(), -outer.y(), bottom}, {inner.x(), -inner.y(), top}),
                 box({-inner.x(), inner.y(), bottom}, {inner.x(), outer.y(), top})});
}

}  // namespace

std::vector<Marker> nominal_markers(const Eigen::Vector2d& film_mm) {
  const Eigen::Vector2d bar = film_mm.array() / 2 + kBarWidth_mm / 2;
  constexpr double kQuarter = std::numbers::pi / 2;
  // The rotations are chosen so that a marker that is knocked over falls along its bar.
  return {{"left", {-bar.x(), -0.20 * film_mm.y(), kBarTop_mm}, kQuarter},
          {"right", {bar.x(), 0.30 * film_mm.y(), kBarTop_mm}, kQuarter},
          {"near", {-0.15 * film_mm.x(), -bar.y(), kBarTop_mm}, 0},
          // To the right, where the gripper's rod does not block the projector's light.
          {"far", {0.30 * film_mm.x(), bar.y(), kBarTop_mm}, 0}};
}

std::vector<Body> standing_bodies(const Eigen::Vector2d& film_mm) {
  const Eigen::Vector2d film = film_mm / 2;
  const Eigen::Vector2d vat = film.array() + (kBarWidth_mm + kGap_mm);
  return {{"table",
           box({-kTableHalf_mm, -kTableHalf_mm, kTable_mm - 10},
               {kTableHalf_mm, kTableHalf_mm, kTable_mm}),
           false},
          {"vat", frame(vat, kWall_mm, kTable_mm, kRim_mm), false},
          {"water", box({-vat.x(), -vat.y(), kTable_mm}, {vat.x(), vat.y(), 0}), false},
          {"bars", frame(film, kBarWidth_mm, kBarBottom_mm, kBarTop_mm), false}};
}

Body gripper() {
  return {"gripper", joined({box({-20, -12, 0}, {20, 12, 25}), rod(10, 25, 700)}), true};
}

}  // namespace hydroprint::simulated_scene
