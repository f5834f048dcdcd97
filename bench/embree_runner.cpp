// Embree as a runner: the ray-traced answer to the same question. A frame moves every vertex to its
// place and builds the tree (Stage::volumes), finds what each pixel sees (Stage::scene) and whether
// the light is hidden from there (Stage::shadow). Nothing is shaded: that is on the ray tracer's
// side.
//
// For speed: build quality low, which costs a third of medium's time and hardly slows the rays;
// packets of 16 coherent rays of 4x4 pixels; tiles on oneTBB; no robust mode; no shadow ray where
// the surface turns away from the light.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <embree3/rtcore.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "ar/stopwatch.h"
#include "bench/runner.h"
#include "pipeline/ray_reference.h"

namespace gnomon::bench {
namespace {

constexpr int kPacketEdge = 4, kPacket = 16, kTileEdge = 32;
/// Where a shadow ray begins, as a part of the way to the light: past its own surface's rounding.
constexpr float kShadowNear = 1e-4f;

/// The mask of a packet with every ray alive.
constexpr std::array<int, kPacket> all_valid() {
  std::array<int, kPacket> valid{};
  valid.fill(-1);
  return valid;
}
alignas(64) constexpr std::array<int, kPacket> kAllValid = all_valid();

struct Body {
  RTCGeometry geometry = nullptr;
  glm::vec3* corners = nullptr;
  std::vector<glm::vec3> model;
  glm::mat4 world_from_model{1.0f};
};

/// A packet of 4x4 pixels and what became of it.
struct alignas(64) Packet {
  RTCRayHit16 rays;
};

class EmbreeRunner final : public Runner {
 public:
  EmbreeRunner(const Subject& subject, int threads)
      : subject_(subject),
        limit_(oneapi::tbb::global_control::max_allowed_parallelism,
               static_cast<std::size_t>(threads)),
        arena_(threads),
        columns_((subject.size.width + kPacketEdge - 1) / kPacketEdge),
        rows_((subject.size.height + kPacketEdge - 1) / kPacketEdge),
        packets_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)),
        picture_(static_cast<std::size_t>(subject.size.width) *
                 static_cast<std::size_t>(subject.size.height)) {
    device_ = rtcNewDevice(("threads=" + std::to_string(threads)).c_str());
    if (!device_) throw std::runtime_error("Embree cannot start");
    scene_ = rtcNewScene(device_);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_LOW);
    for (const pipeline::Object& object : subject_.scene.objects) add(object);
    set_up_camera();
  }

  ~EmbreeRunner() override {
    for (const Body& body : bodies_) rtcReleaseGeometry(body.geometry);
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  EmbreeRunner(const EmbreeRunner&) = delete;
  EmbreeRunner& operator=(const EmbreeRunner&) = delete;

  StageTimes frame() override {
    StageTimes times;
    arena_.execute([&] {
      ar::Stopwatch timer;
      build();
      for_tiles([this](std::size_t, int x, int y) {
        Packet packet;
        trace(packet, x, y);
        shade(packet, x, y);
      });
      at(times, Stage::frame) = timer.lap_ms();
      build();
      at(times, Stage::volumes) = timer.lap_ms();
      for_tiles([this](std::size_t index, int x, int y) { trace(packets_[index], x, y); });
      at(times, Stage::scene) = timer.lap_ms();
      for_tiles([this](std::size_t index, int x, int y) { shade(packets_[index], x, y); });
      at(times, Stage::shadow) = timer.lap_ms();
    });
    return times;
  }

  Picture picture() override { return picture_; }

 private:
  void add(const pipeline::Object& object) {
    for (const pipeline::Part& part : object.model->parts) {
      Body body{.world_from_model = object.world_from_model};
      for (const glm::vec4& position : part.mesh.positions) body.model.emplace_back(position);
      body.geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
      body.corners = static_cast<glm::vec3*>(
          rtcSetNewGeometryBuffer(body.geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                  sizeof(glm::vec3), body.model.size()));
      auto* indices = static_cast<std::uint32_t*>(
          rtcSetNewGeometryBuffer(body.geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                  3 * sizeof(std::uint32_t), part.mesh.triangle_count()));
      std::copy(part.mesh.indices.begin(), part.mesh.indices.end(), indices);
      rtcSetGeometryBuildQuality(body.geometry, RTC_BUILD_QUALITY_LOW);
      rtcAttachGeometry(scene_, body.geometry);
      bodies_.push_back(std::move(body));
    }
  }

  void build() {
    oneapi::tbb::parallel_for(std::size_t{0}, bodies_.size(), [this](std::size_t index) {
      const Body& body = bodies_[index];
      for (std::size_t i = 0; i < body.model.size(); ++i) {
        body.corners[i] = glm::vec3(body.world_from_model * glm::vec4(body.model[i], 1.0f));
      }
      rtcUpdateGeometryBuffer(body.geometry, RTC_BUFFER_TYPE_VERTEX, 0);
      rtcCommitGeometry(body.geometry);
    });
    rtcCommitScene(scene_);
  }

  /// Directions that end on a plane across the camera's axis are linear in the pixel:
  /// corner + x * across + y * up. Along the axis clip w grows.
  void set_up_camera() {
    const auto [width, height] = subject_.size;
    const glm::mat4& clip = subject_.camera.clip_from_world;
    const glm::dvec3 axis(clip[0][3], clip[1][3], clip[2][3]);
    const auto end = [&](double x, double y) {
      const pipeline::Ray ray = pipeline::window_ray(subject_.camera, x, y);
      return ray.direction / glm::dot(ray.direction, axis);
    };
    const glm::dvec3 corner = end(0.5, 0.5);
    corner_ = glm::vec3(corner);
    across_ = glm::vec3((end(width + 0.5, 0.5) - corner) / static_cast<double>(width));
    up_ = glm::vec3((end(0.5, height + 0.5) - corner) / static_cast<double>(height));
    eye_ = subject_.camera.eye_world;
  }

  template <class Work>
  void for_tiles(const Work& work) {
    constexpr int kEdge = kTileEdge / kPacketEdge;
    const int tile_columns = (columns_ + kEdge - 1) / kEdge,
              tile_rows = (rows_ + kEdge - 1) / kEdge;
    oneapi::tbb::parallel_for(0, tile_columns * tile_rows, [&](int tile) {
      const int column = tile % tile_columns * kEdge, row = tile / tile_columns * kEdge;
      for (int r = row; r < std::min(row + kEdge, rows_); ++r) {
        for (int c = column; c < std::min(column + kEdge, columns_); ++c) {
          work(static_cast<std::size_t>(r) * static_cast<std::size_t>(columns_) +
                   static_cast<std::size_t>(c),
               c * kPacketEdge, r * kPacketEdge);
        }
      }
    });
  }

  void trace(Packet& packet, int x, int y) const {
    RTCRayHit16& out = packet.rays;
    for (int i = 0; i < kPacket; ++i) {
      const glm::vec3 direction = corner_ + static_cast<float>(x + i % kPacketEdge) * across_ +
                                  static_cast<float>(y + i / kPacketEdge) * up_;
      out.ray.org_x[i] = eye_.x;
      out.ray.org_y[i] = eye_.y;
      out.ray.org_z[i] = eye_.z;
      out.ray.dir_x[i] = direction.x;
      out.ray.dir_y[i] = direction.y;
      out.ray.dir_z[i] = direction.z;
      out.ray.tnear[i] = 0.0f;
      out.ray.tfar[i] = std::numeric_limits<float>::infinity();
      out.ray.time[i] = 0.0f;
      out.ray.mask[i] = 0xffffffffu;
      out.ray.flags[i] = 0;
      out.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      out.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect16(kAllValid.data(), scene_, &context, &out);
  }

  /// Shadow rays of what trace found, and the packet's pixels.
  void shade(const Packet& packet, int x, int y) {
    const RTCRayHit16& seen = packet.rays;
    const glm::vec4 light = subject_.scene.lights[0].position;
    RTCRay16 rays;
    alignas(64) std::array<int, kPacket> valid;
    alignas(64) std::array<std::uint8_t, kPacket> pixels;
    for (int i = 0; i < kPacket; ++i) {
      const bool hit = seen.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
      const glm::vec3 direction(seen.ray.dir_x[i], seen.ray.dir_y[i], seen.ray.dir_z[i]);
      const glm::vec3 normal(seen.hit.Ng_x[i], seen.hit.Ng_y[i], seen.hit.Ng_z[i]);
      const glm::vec3 point = eye_ + (hit ? seen.ray.tfar[i] : 0.0f) * direction;
      const glm::vec3 towards = glm::vec3(light) - light.w * point;
      // The side that is seen faces the light when eye and light are on one side of the triangle.
      const bool faces = -glm::dot(normal, direction) * glm::dot(normal, towards) > 0.0f;
      valid[i] = hit && faces ? -1 : 0;
      pixels[i] = static_cast<std::uint8_t>(hit ? (faces ? 1 : 2) : 0);
      rays.org_x[i] = point.x;
      rays.org_y[i] = point.y;
      rays.org_z[i] = point.z;
      rays.dir_x[i] = towards.x;
      rays.dir_y[i] = towards.y;
      rays.dir_z[i] = towards.z;
      rays.tnear[i] = kShadowNear;
      rays.tfar[i] = light.w == 0.0f ? std::numeric_limits<float>::infinity() : 1.0f;
      rays.time[i] = 0.0f;
      rays.mask[i] = 0xffffffffu;
      rays.flags[i] = 0;
    }
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcOccluded16(valid.data(), scene_, &context, &rays);
    const auto [width, height] = subject_.size;
    for (int i = 0; i < kPacket; ++i) {
      const int px = x + i % kPacketEdge, py = y + i / kPacketEdge;
      if (px >= width || py >= height) continue;
      const bool hidden = valid[i] != 0 && rays.tfar[i] < 0.0f;
      picture_[static_cast<std::size_t>(py) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(px)] = hidden ? std::uint8_t{2} : pixels[i];
    }
  }

  Subject subject_;
  oneapi::tbb::global_control limit_;
  oneapi::tbb::task_arena arena_;
  int columns_, rows_;
  /// Handed from one stage to the next where stages are timed apart.
  std::vector<Packet> packets_;
  Picture picture_;
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
  std::vector<Body> bodies_;
  glm::vec3 eye_{0.0f}, corner_{0.0f}, across_{0.0f}, up_{0.0f};
};

}  // namespace

std::unique_ptr<Runner> make_embree_runner(const Subject& subject, int threads) {
  return std::make_unique<EmbreeRunner>(subject, threads);
}

}  // namespace gnomon::bench
