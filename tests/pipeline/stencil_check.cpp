#include "tests/pipeline/stencil_check.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace gnomon::test {

using namespace pipeline;

namespace {

/// Half the width, in samples, of the grid that is searched within one pixel.
constexpr int kSearch = 6;

/// Is there a place within one pixel where the rays see what the buffers show: no surface, where
/// none was drawn; a surface and the stencil's answer, where one was; any surface, where the rays
/// see none at the pixel's centre?
bool edge_within_a_pixel(const RayReference& rays, const Camera& camera, const glm::vec4& light,
                         int x, int y, bool drawn, bool centre_hit, bool counted_shadow) {
  for (int j = -kSearch; j <= kSearch; ++j) {
    for (int i = -kSearch; i <= kSearch; ++i) {
      const Ray ray = window_ray(camera, x + 0.5 + static_cast<double>(i) / kSearch,
                                 y + 0.5 + static_cast<double>(j) / kSearch);
      const RayHit hit = rays.trace(ray);
      if (hit.hit != drawn) continue;
      if (!drawn || !centre_hit || rays.shadow(hit, light).in_shadow == counted_shadow) return true;
    }
  }
  return false;
}

/// Pixels and a depth buffer's [0, 1] (nearer than the near plane: below 0).
glm::dvec3 to_window(const Camera& camera, const glm::dvec3& p) {
  const glm::dvec4 c = glm::dmat4(camera.clip_from_world) * glm::dvec4(p, 1.0);
  return glm::dvec3(camera.width * 0.5 * c.x, camera.height * 0.5 * c.y, 0.5 * c.z) / c.w +
         glm::dvec3(0.0, 0.0, 0.5);
}

constexpr double kD24 = 16777215.0;

/// One unit of the depth buffer, and one pixel, in metres at a hit.
struct Scales {
  double unit_m, pixel_m, tie_m;
};

/// tie_m is how far along the ray the buffer may see two nearly coplanar surfaces displaced: two
/// units of D24, float32's rounding of the corners, and each surface's corners snapped by up to
/// half of 1/256 pixel in x and y, times the surface's slope.
Scales scales_at(const Camera& camera, const RayHit& hit) {
  const glm::dvec3 along = glm::normalize(hit.point - glm::dvec3(camera.eye_world));
  const double probe = 1e-4;
  const glm::dvec3 here = to_window(camera, hit.point);
  const double unit_m =
      probe / std::abs(to_window(camera, hit.point + probe * along).z - here.z) / kD24;
  const glm::dvec3 side = glm::normalize(glm::cross(
      along, std::abs(along.y) < 0.9 ? glm::dvec3(0.0, 1.0, 0.0) : glm::dvec3(1.0, 0.0, 0.0)));
  const double pixel_m =
      probe / glm::length(glm::dvec2(to_window(camera, hit.point + probe * side) - here));
  const double cosine = std::abs(glm::dot(hit.normal, along));
  const double slope = std::sqrt(std::max(0.0, 1.0 - cosine * cosine)) / std::max(cosine, 1e-6);
  return {unit_m, pixel_m, 2.0 * unit_m + 2e-6 + std::sqrt(2.0) / 256.0 * pixel_m * slope};
}

/// Does the depth buffer hold another surface than the ray's, displaced by more than a tie?
bool shows_another_surface(const Camera& camera, const RayHit& hit, std::uint32_t depth) {
  const Scales scales = scales_at(camera, hit);
  const double z = std::clamp(to_window(camera, hit.point).z, 0.0, 1.0) * kD24;
  return std::abs(z - depth) * scales.unit_m > scales.tie_m;
}

double distance_to_segment(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
  const glm::dvec2 edge = b - a;
  const double square = glm::dot(edge, edge);
  const double t = square > 0.0 ? std::clamp(glm::dot(p - a, edge) / square, 0.0, 1.0) : 0.0;
  return glm::length(a + edge * t - p);
}

/// Does an edge of the object pass within so many pixels, as the camera sees it?
bool object_edge_within(const Object& object, const Camera& camera, int x, int y, double pixels) {
  const glm::dvec2 pixel(x + 0.5 - camera.width * 0.5, y + 0.5 - camera.height * 0.5);
  const glm::dmat4 world(object.world_from_model);
  for (const Part& part : object.model->parts) {
    const Mesh& mesh = part.mesh;
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
      const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
      const glm::dvec3 a(world * glm::dvec4(mesh.positions[mesh.indices[i]]));
      const glm::dvec3 b(world * glm::dvec4(mesh.positions[mesh.indices[next]]));
      const glm::dvec3 wa = to_window(camera, a), wb = to_window(camera, b);
      if (wa.z < 0.0 || wa.z > 1.0 || wb.z < 0.0 || wb.z > 1.0) continue;
      if (distance_to_segment(pixel, glm::dvec2(wa), glm::dvec2(wb)) <= pixels) return true;
    }
  }
  return false;
}

/// Does an edge of a mesh pass within one pixel, as the camera sees it? A sheet seen edge-on slips
/// between rays, not between pixels that its snapped corners cover.
bool mesh_edge_within_a_pixel(const Scene& scene, const Camera& camera, int x, int y) {
  return std::any_of(scene.objects.begin(), scene.objects.end(), [&](const Object& object) {
    return object_edge_within(object, camera, x, y, 1.0);
  });
}

/// How far the snap to 1/256 pixel moves an edge: half of that in x and y. The pixel may show the
/// triangle on the edge's other side, be it seen so obliquely that no ray nearby meets it.
constexpr double kSnap = 0.70710678118654757 / 256.0;

/// Does another surface lie behind the visible one by no more than a tie, for which the rays say
/// what the stencil says? Of two surfaces that have one depth in the buffer it holds the one that
/// was drawn first. It may be nearer to the other than the rays' origins are lifted, so the place
/// between the two counts as well.
bool ties_with_the_next_surface(const RayReference& rays, const Camera& camera, const RayHit& hit,
                                const glm::vec4& light, bool counted_shadow) {
  const glm::dvec3 along = glm::normalize(hit.point - glm::dvec3(camera.eye_world));
  // Past the visible surface itself: float32's rounding.
  const double step = 0x1p-21 * std::max(1.0, glm::length(hit.point));
  const RayHit next = rays.trace({hit.point + along * step, along});
  const double gap = step + next.distance;
  if (!next.hit || gap > scales_at(camera, hit).tie_m) return false;
  return rays.shadow(next, light).in_shadow == counted_shadow ||
         rays.blocked(hit.point + along * (0.5 * gap), light) == counted_shadow;
}

/// Do the rays say what the stencil says when the visible point moves towards the viewer by no more
/// than that? Never into its own body, but into another mesh that casts in its place: of two
/// triangles in one plane that have other corners, either may come out in front.
bool is_depth_tie(const RayReference& rays, const Camera& camera, const Object& object,
                  const RayHit& hit, const glm::vec4& light, bool counted_shadow) {
  const double step = scales_at(camera, hit).tie_m;
  const glm::dvec3 back = glm::normalize(glm::dvec3(camera.eye_world) - hit.point);
  for (const double move : {0.25, 0.5, 1.0, -0.25, -0.5, -1.0}) {
    if (move < 0.0 && object.casts_as_drawn()) break;
    if (rays.blocked(hit.point + back * (move * step), light) == counted_shadow) return true;
  }
  return false;
}

}  // namespace

Disagreement& Disagreement::operator+=(const Disagreement& other) {
  before_near += other.before_near;
  tested += other.tested;
  wrong += other.wrong;
  at_edge += other.at_edge;
  depth_tie += other.depth_tie;
  unexplained += other.unexplained;
  return *this;
}

Counted count_scene(const Scene& scene, const Camera& camera, const VolumeOptions& options,
                    const CountOptions& count_options) {
  Counted counted{raster::DepthBuffer(camera.width, camera.height),
                  raster::StencilBuffer(camera.width, camera.height)};
  TopologyCache topologies;
  const std::vector<PlacedObject> objects = place_objects(scene, camera, topologies);
  const std::vector<PlacedVolume> volumes = make_volumes(
      objects, scene.lights[0], Receivers(scene), near_region(camera.clip_from_world), options);
  for (const PlacedVolume& volume : volumes) {
    ++(volume.method == VolumeMethod::zpass ? counted.zpass : counted.zfail);
  }
  raster::Frame frame;
  const raster::Targets targets{.depth = &counted.depth, .stencil = &counted.stencil};
  frame.begin_pass("surfaces", targets);
  frame.clear({.depth = 1.0f, .stencil = 0});
  raster::State state = surface_state();
  state.depth = raster::DepthState{};
  for (const PlacedObject& object : objects) draw_depth(frame, object, state);
  frame.begin_pass("volumes", targets);
  count_volumes(frame, volumes, count_options);
  raster::execute(frame);
  return counted;
}

Reason why(const Scene& scene, const RayReference& rays, const Camera& camera,
           const glm::vec4& light, int x, int y, std::uint32_t depth, bool counted_shadow) {
  const RayHit hit = rays.trace(window_ray(camera, x + 0.5, y + 0.5));
  const bool drawn = depth != raster::DepthBuffer(1, 1).max_value();
  if (edge_within_a_pixel(rays, camera, light, x, y, drawn, hit.hit, counted_shadow) ||
      (drawn && hit.hit && shows_another_surface(camera, hit, depth)) ||
      (drawn && !hit.hit && mesh_edge_within_a_pixel(scene, camera, x, y)) ||
      (drawn && hit.hit && object_edge_within(scene.objects[hit.object], camera, x, y, kSnap))) {
    return Reason::edge;
  }
  if (hit.hit &&
      (is_depth_tie(rays, camera, scene.objects[hit.object], hit, light, counted_shadow) ||
       ties_with_the_next_surface(rays, camera, hit, light, counted_shadow)))
    return Reason::depth_tie;
  return Reason::none;
}

Disagreement compare_with_rays(const Counted& counted, const Scene& scene, const RayReference& rays,
                               const Camera& camera) {
  const glm::vec4 light = scene.lights[0].position;
  Disagreement result;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const bool drawn = counted.depth.at(x, y) != counted.depth.max_value();
      const RayHit hit = rays.trace(window_ray(camera, x + 0.5, y + 0.5));
      if (!drawn && !hit.hit) continue;
      // In front of the near plane there is one depth, 0, for everything.
      if (hit.hit && to_window(camera, hit.point).z < 0.0) {
        ++result.before_near;
        continue;
      }
      ++result.tested;
      const bool counted_shadow = counted.stencil.at(x, y) != 0;
      if (hit.hit && rays.shadow(hit, light).in_shadow == counted_shadow) continue;
      ++result.wrong;
      const Reason reason =
          why(scene, rays, camera, light, x, y, counted.depth.at(x, y), counted_shadow);
      result.at_edge += reason == Reason::edge;
      result.depth_tie += reason == Reason::depth_tie;
      result.unexplained += reason == Reason::none;
    }
  }
  return result;
}

}  // namespace gnomon::test
