// What sweeps of views have in common: words, the size of pictures, scenes, and random numbers that
// are the same on every machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "pipeline/scene.h"

namespace gnomon::apps::study {

inline constexpr int kSweepWidth = 240, kSweepHeight = 180;
inline constexpr const char* kWrongPixels = "wrong pixels of those that the light reaches";
inline constexpr const char* kRays = "Embree rays";

/// The generator's own words, since what the library's distributions make of them differs.
class RandomNumbers {
 public:
  explicit RandomNumbers(std::size_t seed) : words_(static_cast<std::uint32_t>(seed)) {}
  /// From 0 to count - 1. Precondition: count is positive and below 2^32.
  std::size_t below(std::size_t count);
  /// From -1 on, less than 1; a multiple of 2^-23.
  float signed_unit();
  /// Each coordinate a signed_unit.
  glm::vec3 in_cube();
  /// So many different numbers below `count`, in random order; all of them if there are no more.
  std::vector<std::size_t> some_of(std::size_t count, std::size_t wanted);

 private:
  std::mt19937 words_;
};

/// "0.05", "1e-06": the shortest that says it.
std::string number_text(double value);
std::vector<std::string> number_texts(const std::vector<double>& values);

/// A square ground of that half size, which does not cast, and the light.
pipeline::Scene ground_under(const glm::vec4& light, float half = 4.0f);

void add_object(pipeline::Scene& scene, const char* name,
                std::shared_ptr<const pipeline::Model> model, const glm::mat4& place);

/// A box under a lamp, its shadow on the ground, and two bodies to look at.
pipeline::Scene box_under_lamp();

/// A camera that looks at `at` from `distance_m` away, from another side for each number.
pipeline::Camera look_from_side(std::size_t number, const glm::vec3& at, float distance_m);

}  // namespace gnomon::apps::study
