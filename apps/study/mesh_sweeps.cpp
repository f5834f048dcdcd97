#include "apps/study/mesh_sweeps.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "apps/study/sweep_views.h"
#include "apps/study/trial_sweep.h"
#include "pipeline/shapes.h"

namespace gnomon::apps::study {

using namespace pipeline;

namespace {

/// 320 and 384 triangles, in turns.
Mesh body(std::size_t input) {
  return input % 2 ? torus_mesh(0.55f, 0.2f, 24, 8) : icosphere_mesh(0.6f, 2);
}

View body_over_ground(Mesh mesh, std::size_t input) {
  const bool lamp = input % 4 < 2;
  Scene scene =
      ground_under(lamp ? glm::vec4(0.9f, 3.5f, 0.6f, 1.0f) : glm::vec4(0.36f, 0.8f, 0.48f, 0.0f));
  add_object(scene, "body", model_of(std::move(mesh)),
             placed({0.0f, 1.0f, 0.0f}, {0.3f, 0.2f, 1.0f}, 0.5f * static_cast<float>(input)));
  add_object(scene, "ball", model_of(icosphere_mesh(0.3f, 3)), placed({-0.5f, 0.3f, -0.4f}));
  return {"", std::move(scene), look_from_side(input, {-0.1f, 0.6f, -0.1f}, 3.6f)};
}

constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();
constexpr std::array<std::size_t, 9> kDefects = {0, 1, 2, 5, 10, 20, 50, 100, kAll};

using Corners = std::array<std::uint32_t, 3>;

Corners corners_of(const Mesh& mesh, std::size_t triangle) {
  const std::uint32_t* at = &mesh.indices[3 * triangle];
  return {at[0], at[1], at[2]};
}

void remove(Mesh& mesh, std::vector<std::size_t> triangles, RandomNumbers&) {
  std::ranges::sort(triangles);
  std::vector<std::uint32_t> left;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    if (!std::ranges::binary_search(triangles, t))
      for (const std::uint32_t i : corners_of(mesh, t)) left.push_back(i);
  mesh.indices = std::move(left);
}

void flip(Mesh& mesh, std::vector<std::size_t> triangles, RandomNumbers&) {
  for (const std::size_t t : triangles) std::swap(mesh.indices[3 * t + 1], mesh.indices[3 * t + 2]);
}

void duplicate(Mesh& mesh, std::vector<std::size_t> triangles, RandomNumbers&) {
  for (const std::size_t t : triangles)
    for (const std::uint32_t i : corners_of(mesh, t)) mesh.indices.push_back(i);
}

/// Gives them corners of their own, up to 5 mm away along each axis.
void tear(Mesh& mesh, std::vector<std::size_t> triangles, RandomNumbers& random) {
  for (const std::size_t t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t& index = mesh.indices[3 * t + k];
      const glm::vec4 moved = mesh.positions[index] + glm::vec4(0.005f * random.in_cube(), 0.0f);
      const glm::vec3 normal = mesh.normals[index];
      index = static_cast<std::uint32_t>(mesh.positions.size());
      mesh.positions.push_back(moved);
      mesh.normals.push_back(normal);
    }
  }
}

using Damage = void (*)(Mesh&, std::vector<std::size_t>, RandomNumbers&);

TrialSweep::Plan damaged(const char* name, const char* title, const char* explanation,
                         Damage damage) {
  TrialSweep::Plan plan;
  plan.text = {name,
               title,
               std::string(explanation) +
                   " A ball of 320 triangles and a torus of 384, in turns, over the ground under a "
                   "lamp and a light at infinity; eight choices.",
               "triangles",
               kWrongPixels,
               kRays};
  for (const std::size_t count : kDefects)
    plan.values.push_back(count == kAll ? "all" : std::to_string(count));
  plan.inputs = 8;
  plan.settings = swept_settings();
  plan.view = [damage](std::size_t value, std::size_t input) {
    RandomNumbers random(input);
    Mesh mesh = body(input);
    damage(mesh, random.some_of(mesh.triangle_count(), kDefects[value]), random);
    return body_over_ground(std::move(mesh), input);
  };
  return plan;
}

const std::vector<double> kSoup = {1, 2, 5, 10, 20, 50, 100, 200, 500, 1000};

/// With one normal for all, since neighbours share none.
Mesh soup(std::size_t triangles, std::size_t seed) {
  RandomNumbers random(seed);
  Mesh mesh;
  for (std::size_t t = 0; t < triangles; ++t) {
    const glm::vec3 middle = 0.6f * random.in_cube();
    for (int k = 0; k < 3; ++k) {
      mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
      mesh.positions.emplace_back(middle + 0.25f * random.in_cube(), 1.0f);
      mesh.normals.emplace_back(0.0f, 1.0f, 0.0f);
    }
  }
  return mesh;
}

TrialSweep::Plan growing_soup() {
  TrialSweep::Plan plan;
  plan.text = {"mesh-soup",
               "A soup of triangles grows",
               "A caster of random triangles that share no edges and cut each other, over the "
               "ground; eight soups.",
               "triangles",
               kWrongPixels,
               kRays};
  plan.values = number_texts(kSoup);
  plan.inputs = 8;
  plan.settings = swept_settings();
  plan.view = [](std::size_t value, std::size_t input) {
    return body_over_ground(soup(static_cast<std::size_t>(kSoup[value]), input), input);
  };
  return plan;
}

}  // namespace

void add_mesh_sweeps(Sweeps& sweeps, int threads) {
  for (TrialSweep::Plan& plan : std::array{
           damaged("mesh-removed", "Triangles are missing",
                   "Random triangles are taken out of a closed body, up to all.", remove),
           damaged("mesh-flipped", "Triangles are turned inside out",
                   "Random triangles of a closed body are turned, up to all.", flip),
           damaged("mesh-duplicated", "Triangles are there twice",
                   "Random triangles of a closed body are there twice, up to all.", duplicate),
           damaged("mesh-torn", "Triangles are torn off",
                   "Random triangles of a closed body get corners of their own, up to 5 mm away "
                   "along each axis.",
                   tear),
           growing_soup()})
    sweeps.push_back(std::make_unique<TrialSweep>(std::move(plan), threads));
}

}  // namespace gnomon::apps::study
