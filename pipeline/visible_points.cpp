// Rounding. Products of float32 are exact in double, so a transformed coordinate, a sum of four of
// them, is off by at most 3 kRounding times the sum of their sizes, which is at most `reach` for
// all corners of an object: 4 kRounding * reach with what is of second order. A point a + s (b - a)
// + t (c - a), with s, t and s + t from 0 to 1, adds: 2 roundings of a difference of at most
// 2 reach, 2 of products of it, 2 of sums of at most 5 reach; less than 20 kRounding * reach.
#include "pipeline/visible_points.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "pipeline/plane_side.h"
#include "raster/check.h"
#include "raster/executor.h"

namespace gnomon::pipeline {
namespace {

/// Pixels, and vertices, that one piece of work takes.
constexpr std::size_t kChunk = 4096;
/// A number is drawn as two digits of this base; float32 weights that add up to 1 but for 2^-22
/// give a digit back within 2^-6.
constexpr std::uint32_t kBase = 1 << 16;

std::shared_ptr<const Mesh> numbered_mesh(const Mesh& mesh) {
  auto numbered = std::make_shared<Mesh>();
  numbered->positions.reserve(mesh.indices.size());
  numbered->colors.reserve(mesh.indices.size());
  numbered->indices.reserve(mesh.indices.size());
  for (std::uint32_t i = 0; i < mesh.indices.size(); ++i) {
    const std::uint32_t triangle = i / 3;
    numbered->positions.push_back(mesh.positions[mesh.indices[i]]);
    numbered->colors.emplace_back(static_cast<float>(triangle % kBase),
                                  static_cast<float>(triangle / kBase), 1.0f, 1.0f);
    numbered->indices.push_back(i);
  }
  return numbered;
}

/// The digit that a channel shows; 0, as where nothing is drawn, for what is none.
std::uint32_t digit(float value) {
  const float rounded = std::round(value);
  return rounded > 0.0f && rounded < static_cast<float>(kBase) ? static_cast<std::uint32_t>(rounded)
                                                               : 0;
}

/// The weights, none negative, of a triangle's corners where the line of sight at (x, y) meets it,
/// or near there if it passes by. Corners are clip space's x, y and w.
glm::dvec3 weights_on_line(const std::array<glm::dvec3, 3>& clip, double x_ndc, double y_ndc) {
  // Where weights w make sum w_k (x_k - x w_k, y_k - y w_k) null.
  glm::dvec3 u, v;
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3& corner = clip[static_cast<std::size_t>(k)];
    u[k] = corner.x - x_ndc * corner.z;
    v[k] = corner.y - y_ndc * corner.z;
  }
  const glm::dvec3 raw = glm::cross(u, v);
  const double sum = raw.x + raw.y + raw.z;
  const glm::dvec3 inside = glm::max(raw / sum, glm::dvec3(0.0));
  const double rest = inside.x + inside.y + inside.z;
  if (!(rest > 0.0 && std::isfinite(rest))) return glm::dvec3(1.0 / 3.0);
  return inside / rest;
}

}  // namespace

void place_corners(const Topology& topology, const glm::mat4& world_from_model, int threads,
                   WorldCorners& corners) {
  const glm::dmat4 world(world_from_model);
  corners.at.resize(topology.positions.size());
  raster::for_each_chunk(
      corners.at.size(), kChunk, threads, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
          const glm::dvec3 p(topology.positions[i]);
          for (int row = 0; row < 3; ++row)
            corners.at[i][row] =
                ((world[0][row] * p.x + world[1][row] * p.y) + world[2][row] * p.z) + world[3][row];
        }
      });
  const glm::dvec3 farthest = glm::max(glm::abs(topology.low), glm::abs(topology.high));
  double reach = 0.0;
  for (int row = 0; row < 3; ++row)
    reach = std::max(reach, std::abs(world[0][row]) * farthest.x +
                                std::abs(world[1][row]) * farthest.y +
                                std::abs(world[2][row]) * farthest.z + std::abs(world[3][row]));
  corners.error_m = 4.0 * kRounding * reach;
  corners.apart_m = 0x1p-23 * reach;
  for (std::size_t i = 0; i < topology.indices.size(); ++i) {
    const glm::dvec3& p = corners.at[topology.indices[i]];
    corners.low = i == 0 ? p : glm::min(corners.low, p);
    corners.high = i == 0 ? p : glm::max(corners.high, p);
  }
}

const PointFinder::NumberedModel& PointFinder::numbered(const std::shared_ptr<const Model>& model) {
  for (const NumberedModel& known : models_) {
    if (known.model == model) return known;
  }
  NumberedModel fresh{model, {}};
  for (const Part& part : model->parts) fresh.parts.push_back(numbered_mesh(part.mesh));
  models_.push_back(std::move(fresh));
  return models_.back();
}

void PointFinder::draw_numbers(std::span<const PlacedObject> objects, raster::DepthFormat format,
                               int threads) {
  if (!depth_ || depth_->width() != width_ || depth_->height() != height_ ||
      depth_->format() != format) {
    depth_ = std::make_unique<raster::DepthBuffer>(width_, height_, format);
    numbers_ = std::make_unique<raster::ColorBuffer>(width_, height_, raster::ColorFormat::rgba32f);
  }
  parts_.clear();
  raster::Frame frame;
  frame.begin_pass("visible surfaces", {.color = numbers_.get(), .depth = depth_.get()});
  frame.clear({.color = glm::vec4(0.0f), .depth = 1.0f});
  for (std::uint32_t o = 0; o < objects.size(); ++o) {
    const PlacedObject& object = objects[o];
    const NumberedModel& model = numbered(object.object->model);
    std::uint32_t first_vertex = 0;
    for (std::uint32_t p = 0; p < model.parts.size(); ++p) {
      parts_.push_back({o, p, first_vertex});
      raster::require(parts_.size() < kBase, "a scene has fewer than 65536 parts");
      first_vertex += static_cast<std::uint32_t>(model.model->parts[p].mesh.positions.size());
      raster::Draw draw;
      draw.state = surface_state();
      draw.state.depth = raster::DepthState{};
      draw.state.front_face = object.front_face;
      draw.mesh = model.parts[p]->view();
      draw.clip_from_model = object.clip_from_model;
      draw.shading = raster::Flat{{1.0f, 1.0f, static_cast<float>(parts_.size()), 1.0f}};
      frame.draw(std::move(draw));
    }
  }
  raster::execute(frame, {.threads = threads, .memory = &executing_});
}

VisiblePoint PointFinder::point_at(std::span<const PlacedObject> objects,
                                   const glm::dmat4& clip_from_world, const glm::dvec4& eye, int x,
                                   int y) const {
  VisiblePoint point;
  const glm::vec4 color = numbers_->at(x, y);
  const std::uint32_t number = digit(color.b);
  if (number == 0 || number > parts_.size()) return point;
  const NumberedPart& part = parts_[number - 1];
  const PlacedObject& object = objects[part.object];
  const Mesh& mesh = object.object->model->parts[part.part].mesh;
  const std::size_t first = 3 * (std::size_t{digit(color.g)} * kBase + digit(color.r));
  if (first + 2 >= mesh.indices.size()) return point;

  const WorldCorners& corners = corners_[part.object];
  std::array<glm::dvec3, 3> world, clip;
  for (std::size_t k = 0; k < 3; ++k) {
    point.corners[k] = object.topology->welded[part.first_vertex + mesh.indices[first + k]];
    world[k] = corners.at[point.corners[k]];
    const glm::dvec4 c = clip_from_world * glm::dvec4(world[k], 1.0);
    clip[k] = {c.x, c.y, c.w};
  }
  const glm::dvec3 weights =
      weights_on_line(clip, 2.0 * (x + 0.5) / width_ - 1.0, 2.0 * (y + 0.5) / height_ - 1.0);
  point.at = (world[0] + (world[1] - world[0]) * weights.y) + (world[2] - world[0]) * weights.z;
  const glm::dvec3 normal = glm::cross(world[1] - world[0], world[2] - world[0]);
  const double length = glm::length(normal);
  const double side = glm::dot(normal, glm::dvec3(eye) - world[0] * eye.w);
  if (length > 0.0) point.at += normal * (std::copysign(corners.apart_m, side) / length);
  point.error_m = 6.0 * corners.error_m;
  point.object = part.object;
  return point;
}

void PointFinder::find(std::span<const PlacedObject> objects, const Camera& camera, int width,
                       int height, raster::DepthFormat format, int threads) {
  width_ = width;
  height_ = height;
  draw_numbers(objects, format, threads);
  corners_.resize(objects.size());
  for (std::size_t i = 0; i < objects.size(); ++i)
    place_corners(*objects[i].topology, objects[i].object->world_from_model, threads, corners_[i]);
  points_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const glm::dmat4 clip_from_world(camera.clip_from_world);
  const glm::dvec4 eye = eye_of(camera.clip_from_world);
  raster::for_each_chunk(points_.size(), kChunk, threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const auto columns = static_cast<std::size_t>(width);
      points_[i] = point_at(objects, clip_from_world, eye, static_cast<int>(i % columns),
                            static_cast<int>(i / columns));
    }
  });
}

glm::dvec4 eye_of(const glm::mat4& clip_from_world) {
  const glm::dmat4 rows = glm::transpose(glm::dmat4(clip_from_world));
  const glm::dvec4 &x = rows[0], &y = rows[1], &w = rows[3];
  // What all three rows take to 0.
  const auto minor = [&](int i, int j, int k) {
    return glm::determinant(glm::dmat3(x[i], x[j], x[k], y[i], y[j], y[k], w[i], w[j], w[k]));
  };
  const glm::dvec4 eye(minor(1, 2, 3), -minor(0, 2, 3), minor(0, 1, 3), -minor(0, 1, 2));
  // It lies before the near plane, where clip space's z is negative.
  return glm::dot(rows[2], eye) > 0.0 ? -eye : eye;
}

}  // namespace gnomon::pipeline
