#include "explain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "raster/clip.h"
#include "raster/geometry.h"
#include "raster/kernels.h"

namespace gnomon::peer {

namespace {

using namespace gnomon::raster;

/// A triangle's depth at a pixel centre, and how far it moves with a vertex that moves by 1/256
/// pixel along x and y: inside a triangle every point moves by no more than its vertices do.
struct Layer {
  double depth = 0.0, slack = 0.0;
};

/// What the pass's geometry is at a pixel.
struct Site {
  std::size_t pixel = 0;
  int x = 0, y = 0;
  double edge_px = std::numeric_limits<double>::infinity();
  std::vector<Layer> layers;
};

double distance_to_segment(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
  const glm::dvec2 along = b - a;
  const double length2 = glm::dot(along, along);
  const double t = length2 > 0.0 ? std::clamp(glm::dot(p - a, along) / length2, 0.0, 1.0) : 0.0;
  return glm::length(p - (a + t * along));
}

struct Outline {
  std::array<glm::dvec2, 10> corners;
  std::size_t count = 0;
};

/// Calls body with the outline of each of the draw's triangles after clipping, in window
/// coordinates without a snap. The guard is far outside the picture: where Mesa cuts at its sides,
/// no edge is seen.
template <class Body>
void for_each_outline(const DrawSetup& setup, const std::vector<glm::vec4>& clip,
                      const Body& body) {
  const Rect& v = setup.viewport;
  const ClipVolume volume{64.0, 64.0, !setup.draw->state.depth_clamp};
  const auto& indices = setup.draw->mesh.indices;
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    const ClippedPolygon polygon =
        clip_triangle({clip[indices[i]], clip[indices[i + 1]], clip[indices[i + 2]]}, volume);
    Outline outline;
    for (; outline.count < static_cast<std::size_t>(polygon.count); ++outline.count) {
      const glm::dvec4& p = polygon.vertices[outline.count].position;
      outline.corners[outline.count] = {(p.x / p.w + 1.0) * 0.5 * v.width + v.x,
                                        (p.y / p.w + 1.0) * 0.5 * v.height + v.y};
    }
    if (outline.count > 0) body(outline);
  }
}

void measure_edges(const DrawSetup& setup, const std::vector<glm::vec4>& clip,
                   std::vector<Site>& sites) {
  for_each_outline(setup, clip, [&](const Outline& outline) {
    glm::dvec2 low = outline.corners[0], high = low;
    for (std::size_t k = 1; k < outline.count; ++k) {
      low = glm::min(low, outline.corners[k]);
      high = glm::max(high, outline.corners[k]);
    }
    for (Site& site : sites) {
      const glm::dvec2 center(site.x + 0.5, site.y + 0.5);
      if (center.x < low.x - 1.0 || center.y < low.y - 1.0 || center.x > high.x + 1.0 ||
          center.y > high.y + 1.0)
        continue;
      for (std::size_t k = 0; k < outline.count; ++k)
        site.edge_px =
            std::min(site.edge_px, distance_to_segment(center, outline.corners[k],
                                                       outline.corners[(k + 1) % outline.count]));
    }
  });
}

/// Length of the part of a segment inside [0, width] x [0, height].
double length_inside(const glm::dvec2& a, const glm::dvec2& b, int width, int height) {
  const glm::dvec2 along = b - a, size(width, height);
  double first = 0.0, last = 1.0;
  for (int axis = 0; axis < 2; ++axis) {
    if (along[axis] == 0.0) {
      if (a[axis] < 0.0 || a[axis] > size[axis]) return 0.0;
      continue;
    }
    const double at_low = -a[axis] / along[axis], at_high = (size[axis] - a[axis]) / along[axis];
    first = std::max(first, std::min(at_low, at_high));
    last = std::min(last, std::max(at_low, at_high));
  }
  return std::max(0.0, last - first) * glm::length(along);
}

void collect_layers(const DrawSetup& setup, const std::vector<glm::vec4>& clip,
                    std::vector<Site>& sites) {
  DrawVertices vertices;
  vertices.resize(clip.size());
  vertices.clip = clip;
  project_vertices(scalar_kernels(), setup, vertices, 0, clip.size());
  SetupTriangles set_up;
  set_up_triangles(scalar_kernels(), setup, vertices, 0, setup.draw->mesh.indices.size() / 3,
                   set_up);
  const auto signed_units = [](std::uint64_t value) {
    return static_cast<double>(static_cast<std::int64_t>(value)) / 256.0;
  };
  for (const SetupTriangle& t : set_up.triangles)
    for (Site& site : sites) {
      if (!t.covers(site.x, site.y)) continue;
      const double slope = std::abs(signed_units(t.step_x)) + std::abs(signed_units(t.step_y));
      const std::uint64_t value = depth_base_at(t.vertices, t.area(), site.x, site.y);
      const double depth =
          std::clamp(signed_units(value), 0.0, static_cast<double>(setup.depth_high));
      site.layers.push_back({depth, slope / 256.0});
    }
}

/// Only draws that can leave a mark in stencil or depth.
bool counts(const Draw& draw) {
  const auto changes = [](const StencilFace& f) {
    return f.write_mask != 0 && (f.fail != StencilOp::keep || f.depth_fail != StencilOp::keep ||
                                 f.pass != StencilOp::keep);
  };
  const bool stencil = draw.state.stencil &&
                       (changes(draw.state.stencil->front) || changes(draw.state.stencil->back));
  return stencil || (draw.state.depth && draw.state.depth->write);
}

/// Calls body(setup, clip) for each draw that counts.
template <class Body>
void for_each_draw(const Pass& pass, const Body& body) {
  for (const Command& command : pass.commands) {
    const Draw* draw = std::get_if<Draw>(&command);
    if (!draw || !counts(*draw)) continue;
    std::vector<glm::vec4> clip(draw->mesh.positions.size());
    scalar_kernels().transform(draw->clip_from_model, draw->mesh.positions.data(), clip.size(),
                               clip.data());
    body(make_draw_setup(*draw, pass.targets), clip);
  }
}

std::vector<Site> survey(const Pass& pass, const std::vector<std::size_t>& pixels, int width) {
  std::vector<Site> sites;
  for (const std::size_t pixel : pixels)
    sites.push_back({.pixel = pixel,
                     .x = static_cast<int>(pixel) % width,
                     .y = static_cast<int>(pixel) / width});
  if (sites.empty()) return sites;
  for_each_draw(pass, [&](const DrawSetup& setup, const std::vector<glm::vec4>& clip) {
    measure_edges(setup, clip, sites);
    if (setup.draw->state.depth) collect_layers(setup, clip, sites);
  });
  return sites;
}

bool clears_stencil(const Pass& pass) {
  const Clear* clear = pass.commands.empty() ? nullptr : std::get_if<Clear>(&pass.commands[0]);
  return clear && clear->stencil && !clear->scissor && clear->stencil_write_mask == 0xff;
}

enum class Tie { none, earlier, level, steep };

/// How the pass's triangles lie to the two stored depths at the site.
Tie find_tie(const Site& site, std::uint32_t stored, std::uint32_t stored_gl) {
  const auto [low, high] =
      std::minmax({static_cast<double>(stored), static_cast<double>(stored_gl)});
  const bool stored_apart = high - low > kDepthTie;
  Tie best = Tie::none;
  for (const Layer& layer : site.layers) {
    const double gap = std::max({low - layer.depth, layer.depth - high, 0.0});
    if (gap <= kDepthTie) return stored_apart ? Tie::earlier : Tie::level;
    if (gap <= kDepthTie + layer.slack) best = stored_apart ? Tie::earlier : Tie::steep;
  }
  return best;
}

}  // namespace

double visible_edges_px(const Pass& pass, int width, int height) {
  double sum = 0.0;
  for_each_draw(pass, [&](const DrawSetup& setup, const std::vector<glm::vec4>& clip) {
    for_each_outline(setup, clip, [&](const Outline& outline) {
      for (std::size_t k = 0; k < outline.count; ++k)
        sum += length_inside(outline.corners[k], outline.corners[(k + 1) % outline.count], width,
                             height);
    });
  });
  return sum;
}

StencilCauses explain_stencil(const Pass& pass, const Step& step) {
  StencilCauses causes;
  std::vector<std::size_t> pixels;
  for (std::size_t i = 0; i < step.after.stencil.size(); ++i)
    if (step.after.stencil[i] != step.after_gl.stencil[i]) pixels.push_back(i);
  causes.differing = pixels.size();
  const bool cleared = clears_stencil(pass);
  for (const Site& site : survey(pass, pixels, step.width)) {
    const std::size_t i = site.pixel;
    const Tie tie = find_tie(site, step.before.depth[i], step.before_gl.depth[i]);
    if (!cleared && step.before.stencil[i] != step.before_gl.stencil[i]) {
      ++causes.earlier;
    } else if (site.edge_px <= kEdgeReach) {
      ++causes.coverage;
      causes.farthest_edge_px = std::max(causes.farthest_edge_px, site.edge_px);
    } else if (tie == Tie::earlier) {
      ++causes.earlier;
    } else if (tie != Tie::none) {
      ++causes.depth_tie;
      causes.steep += tie == Tie::steep;
    } else {
      ++causes.unexplained;
    }
  }
  return causes;
}

DepthCauses explain_depth(const Pass& pass, const Step& step) {
  DepthCauses causes;
  const auto apart = [](const Buffers& a, const Buffers& b, std::size_t i) {
    return a.depth[i] > b.depth[i] ? a.depth[i] - b.depth[i] : b.depth[i] - a.depth[i];
  };
  std::vector<std::size_t> pixels;
  for (std::size_t i = 0; i < step.after.depth.size(); ++i) {
    const std::uint32_t difference = apart(step.after, step.after_gl, i);
    causes.differing += difference != 0;
    if (difference <= kDepthTie) {
      causes.largest_on_surface = std::max(causes.largest_on_surface, difference);
      continue;
    }
    ++causes.large;
    if (apart(step.before, step.before_gl, i) > kDepthTie)
      ++causes.earlier;
    else
      pixels.push_back(i);
  }
  for (const Site& site : survey(pass, pixels, step.width)) {
    const std::uint32_t difference = apart(step.after, step.after_gl, site.pixel);
    const auto [low, high] =
        std::minmax({step.after.depth[site.pixel], step.after_gl.depth[site.pixel]});
    const bool steep = std::any_of(site.layers.begin(), site.layers.end(), [&](const Layer& layer) {
      return layer.depth >= low - kDepthTie - layer.slack &&
             layer.depth <= high + kDepthTie + layer.slack && difference <= kDepthTie + layer.slack;
    });
    if (site.edge_px <= kEdgeReach) {
      ++causes.coverage;
    } else if (steep) {
      ++causes.steep;
      causes.largest_on_surface = std::max(causes.largest_on_surface, difference);
    } else {
      ++causes.unexplained;
    }
  }
  return causes;
}

}  // namespace gnomon::peer
