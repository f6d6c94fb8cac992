#include "hardware/simulator/camera/renderer.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <thread>
#include <utility>

#include "hardware/simulator/scene/hand.h"
#include "hardware/simulator/scene/shapes.h"

namespace hydroprint::simulated_camera {
namespace {

constexpr int kPacket = 8;
static_assert(kWidth_px * kHeight_px / 2 % kPacket == 0);
/// Nothing is measured if the squared cosine of the angle between ray and normal is below this
/// value: less than 10 degrees between ray and surface.
const float kFlattest = static_cast<float>(std::pow(std::sin(std::numbers::pi / 18), 2));
/// Start of a ray to the light, as a fraction of its length, so that the ray does not hit the
/// surface that it leaves.
constexpr float kClear = 5e-4F;

/// Owns an Embree handle.
template <class Handle, void (*release)(Handle)>
class Owned {
 public:
  Owned() = default;
  explicit Owned(Handle handle) : handle_(handle) {}
  Owned(Owned&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
  Owned& operator=(Owned&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  ~Owned() {
    if (handle_ != nullptr) release(handle_);
  }
  [[nodiscard]] Handle get() const { return handle_; }

 private:
  Handle handle_ = nullptr;
};
using Device = Owned<RTCDevice, rtcReleaseDevice>;
using Tree = Owned<RTCScene, rtcReleaseScene>;

/// Creates an empty tree. It is watertight: no ray slips through between two triangles.
Tree empty_tree(RTCDevice device) {
  Tree out(rtcNewScene(device));
  rtcSetSceneFlags(out.get(), RTC_SCENE_FLAG_ROBUST);
  return out;
}

/// Adds a mesh to a tree. Returns false if Embree has too little memory.
bool add(RTCDevice device, RTCScene tree, const simulated_scene::Mesh& mesh) {
  if (mesh.triangles.empty()) return true;
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                             RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                             mesh.points.size()));
  auto* corners = static_cast<unsigned*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(unsigned), mesh.triangles.size()));
  const bool is_there = points != nullptr && corners != nullptr;
  if (is_there) {
    for (const Eigen::Vector3d& p : mesh.points) {
      for (const double x : p) *points++ = static_cast<float>(x);
    }
    for (const Eigen::Vector3i& t : mesh.triangles) {
      for (const int corner : t) *corners++ = static_cast<unsigned>(corner);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(tree, geometry);
  }
  rtcReleaseGeometry(geometry);
  return is_there;
}

}  // namespace

struct Renderer::Rays {
  simulated_scene::Scenery scenery;
  Lens lens;
  std::vector<Eigen::Vector2f> directions;  // directions of the pixels, z = 1
  Device device;
  Tree hanging;                   // in the gripper frame G
  Tree all;                       // in the film frame F
  RTCGeometry gripper = nullptr;  // instance of `hanging` in `all`, which owns it
  unsigned gripper_id = RTC_INVALID_GEOMETRY_ID;
  std::vector<simulated_scene::MarkerState> markers;  // state of the markers in `all`

  [[nodiscard]] bool build_hanging();
  [[nodiscard]] bool build_all();
  void arrange(const simulated_scene::Sight& sight);
  [[nodiscard]] simulated_scene::MarkerState state(std::size_t marker) const {
    return marker < markers.size() ? markers[marker] : simulated_scene::MarkerState::kWell;
  }
};

bool Renderer::Rays::build_hanging() {
  hanging = empty_tree(device.get());
  for (const simulated_scene::Body& body : scenery.bodies) {
    if (body.hangs && !add(device.get(), hanging.get(), body.mesh)) return false;
  }
  rtcCommitScene(hanging.get());
  return rtcGetDeviceError(device.get()) == RTC_ERROR_NONE;
}

bool Renderer::Rays::build_all() {
  all = empty_tree(device.get());
  for (const simulated_scene::Body& body : scenery.bodies) {
    if (!body.hangs && !add(device.get(), all.get(), body.mesh)) return false;
  }
  for (std::size_t i = 0; i < scenery.markers.size(); ++i) {
    const auto mesh = simulated_scene::marker_mesh(scenery.markers[i], state(i));
    if (!add(device.get(), all.get(), mesh)) return false;
  }
  gripper = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(gripper, hanging.get());
  gripper_id = rtcAttachGeometry(all.get(), gripper);
  rtcReleaseGeometry(gripper);
  return rtcGetDeviceError(device.get()) == RTC_ERROR_NONE;
}

void Renderer::Rays::arrange(const simulated_scene::Sight& sight) {
  if (sight.markers != markers) {
    markers = sight.markers;
    (void)build_all();
  }
  const Eigen::Matrix4f at = simulated_scene::gripper_pose(sight).matrix().cast<float>();
  rtcSetGeometryTransform(gripper, 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, at.data());
  rtcCommitGeometry(gripper);
  rtcCommitScene(all.get());
}

Renderer::Renderer(std::unique_ptr<Rays> rays) : rays_(std::move(rays)) {}
Renderer::~Renderer() = default;

Result<std::unique_ptr<Renderer>> Renderer::create(const simulated_scene::Scenery& scenery,
                                                   const Lens& lens) {
  auto rays = std::make_unique<Rays>();
  rays->scenery = scenery;
  rays->lens = lens;
  for (int y = 0; y < kHeight_px; ++y) {
    for (int x = 0; x < kWidth_px; ++x) {
      rays->directions.push_back(unproject(lens, Eigen::Vector2d(x, y)).cast<float>());
    }
  }
  rays->device = Device(rtcNewDevice("threads=1,set_affinity=0"));
  if (rays->device.get() == nullptr || !rays->build_hanging() || !rays->build_all()) {
    return fail(Code::kInternal,
                "the scene cannot be rendered: Embree reports an error. Use a smaller model, or "
                "more memory");
  }
  return std::unique_ptr<Renderer>(new Renderer(std::move(rays)));
}

namespace {

/// Eight rays and their hits.
struct Packet {
  alignas(32) RTCRayHit8 rays;
  alignas(32) int valid[kPacket];
};

void aim(Packet& packet, const Eigen::Vector2f* directions, const Eigen::Isometry3f& X_FC) {
  const Eigen::Vector3f from = X_FC.translation();
  for (int i = 0; i < kPacket; ++i) {
    const Eigen::Vector3f to = X_FC.linear() * directions[i].homogeneous();
    packet.valid[i] = -1;
    packet.rays.ray.org_x[i] = from.x();
    packet.rays.ray.org_y[i] = from.y();
    packet.rays.ray.org_z[i] = from.z();
    packet.rays.ray.dir_x[i] = to.x();
    packet.rays.ray.dir_y[i] = to.y();
    packet.rays.ray.dir_z[i] = to.z();
    packet.rays.ray.tnear[i] = 0;
    packet.rays.ray.tfar[i] = std::numeric_limits<float>::infinity();
    packet.rays.ray.time[i] = 0;
    packet.rays.ray.mask[i] = ~0U;
    packet.rays.ray.flags[i] = 0;
    packet.rays.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    packet.rays.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
}

/// Returns whether a ray has hit a surface at a sufficient angle. `turn`: orientation of the
/// hanging body.
bool faces(const Packet& packet, int i, const Eigen::Matrix3f& turn) {
  const auto& hit = packet.rays.hit;
  if (hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) return false;
  Eigen::Vector3f normal(hit.Ng_x[i], hit.Ng_y[i], hit.Ng_z[i]);
  if (hit.instID[0][i] != RTC_INVALID_GEOMETRY_ID) normal = turn * normal;
  const auto& ray = packet.rays.ray;
  const Eigen::Vector3f direction(ray.dir_x[i], ray.dir_y[i], ray.dir_z[i]);
  const float along = normal.dot(direction);
  return along * along >= kFlattest * normal.squaredNorm() * direction.squaredNorm();
}

/// Returns the rays from the hit points to the light; only those selected by `valid` are
/// meaningful.
RTCRay8 towards(const Packet& packet, const Eigen::Vector3f& light) {
  alignas(32) RTCRay8 out;
  const RTCRay8& in = packet.rays.ray;
  for (int i = 0; i < kPacket; ++i) {
    const float t = packet.valid[i] != 0 ? in.tfar[i] : 0;
    out.org_x[i] = in.org_x[i] + t * in.dir_x[i];
    out.org_y[i] = in.org_y[i] + t * in.dir_y[i];
    out.org_z[i] = in.org_z[i] + t * in.dir_z[i];
    out.dir_x[i] = light.x() - out.org_x[i];
    out.dir_y[i] = light.y() - out.org_y[i];
    out.dir_z[i] = light.z() - out.org_z[i];
    out.tnear[i] = kClear;
    out.tfar[i] = 1;
    out.time[i] = 0;
    out.mask[i] = ~0U;
    out.flags[i] = 0;
  }
  return out;
}

}  // namespace

Depths Renderer::look(const simulated_scene::Sight& sight, const Pose& X_FC, bool lit) {
  rays_->arrange(sight);
  const RTCScene all = rays_->all.get();
  const Eigen::Isometry3f camera = X_FC.cast<float>();
  const Eigen::Vector3f light = (X_FC * Eigen::Vector3d(kBaseline_mm, 0, 0)).cast<float>();
  const Eigen::Matrix3f turn = simulated_scene::gripper_pose(sight).linear().cast<float>();
  Depths out(rays_->directions.size(), 0);
  const auto trace = [&](std::size_t first, std::size_t last) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    Packet packet;
    for (; first < last; first += kPacket) {
      aim(packet, &rays_->directions[first], camera);
      rtcIntersect8(packet.valid, all, &context, &packet.rays);
      for (int i = 0; i < kPacket; ++i) packet.valid[i] = faces(packet, i, turn) ? -1 : 0;
      // Directions have z = 1 in the camera's frame, so the ray parameter at a hit is the depth.
      RTCRay8 back = towards(packet, light);
      if (lit) rtcOccluded8(packet.valid, all, &context, &back);
      for (int i = 0; i < kPacket; ++i) {
        const bool is_dark = lit && back.tfar[i] < 0;  // Embree's result for an occluded ray
        if (packet.valid[i] != 0 && !is_dark) {
          out[first + static_cast<std::size_t>(i)] = packet.rays.ray.tfar[i];
        }
      }
    }
  };
  // One thread is too slow for 30 frames per second.
  const std::size_t half = out.size() / 2;
  std::thread lower(trace, half, out.size());
  trace(0, half);
  lower.join();
  return out;
}

Frame Renderer::photograph(const simulated_scene::Sight& sight, int number) {
  const simulated_scene::Scenery& scenery = rays_->scenery;
  const Pose X_FC = simulated_scene::camera_pose(scenery.stand, scenery.seed, sight.time_s);
  const Errors errors{scenery.has_errors, scenery.has_errors, scenery.has_errors};
  return sense(look(sight, X_FC, scenery.has_errors), rays_->lens.depth_scale, errors, scenery.seed,
               number);
}

Lens lens_of(const simulated_scene::Scenery& scenery) {
  return scenery.has_errors ? drawn_lens(scenery.seed) : Lens{};
}

}  // namespace hydroprint::simulated_camera
