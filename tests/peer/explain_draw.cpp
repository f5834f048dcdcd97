#include "explain_draw.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "llvmpipe_blend.h"
#include "llvmpipe_model.h"
#include "raster/blend.h"
#include "raster/draw_tile.h"
#include "raster/geometry.h"
#include "raster/kernels.h"
#include "raster/unorm.h"

namespace gnomon::peer {

namespace {

using namespace gnomon::raster;

/// A triangle's fragment at a pixel, with the depths that it may have.
struct Fragment {
  bool front = true;
  std::uint32_t depth_low = 0, depth_high = 0;
};

using Fragments = std::vector<Fragment>;

/// How a history's coverage differs from gnomon's; the worst of all triangles'.
enum class Coverage : std::uint8_t { same, snap, cut, impossible };

/// What became of a fragment.
enum class Fate : std::uint8_t { stencil_fail, depth_fail, pass };

/// A mesh triangle at a pixel: gnomon's fragments, and every set of them that llvmpipe may have.
struct Site {
  Fragments own;
  std::vector<Fragments> possible;
  /// What another coverage here would be: the snap's doing alone, or only with the clipper's, or
  /// one of the two rasterizers' mistake.
  Coverage if_other = Coverage::impossible;
  /// gnomon's depths are on the plane, as far as the snap lets them.
  bool own_depths_hold = true;
};

/// The pixel's values as they may be on the way through the draw.
struct PixelState {
  std::uint8_t stencil = 0;
  std::uint32_t depth_low = 0, depth_high = 0;
  Rgba8 color{};
  Coverage coverage = Coverage::same;
  bool other_fate = false;
  bool operator==(const PixelState&) const = default;
};

/// Which outcomes "fragment func stored" may have, each side anywhere in its interval.
struct May {
  bool pass = false, fail = false;
};

May compare_depths(CompareFunc func, const Fragment& f, const PixelState& s) {
  const bool less = f.depth_low<s.depth_high, greater = f.depth_high> s.depth_low;
  const bool equal = f.depth_low <= s.depth_high && s.depth_low <= f.depth_high;
  switch (func) {
    case CompareFunc::never:
      return {false, true};
    case CompareFunc::less:
      return {less, greater || equal};
    case CompareFunc::equal:
      return {equal, less || greater};
    case CompareFunc::less_equal:
      return {less || equal, greater};
    case CompareFunc::greater:
      return {greater, less || equal};
    case CompareFunc::not_equal:
      return {less || greater, equal};
    case CompareFunc::greater_equal:
      return {greater || equal, less};
    case CompareFunc::always:
      return {true, false};
  }
  return {};
}

/// Sends fragments through the tests, along every branch that their depths leave open.
class Pixel {
 public:
  Pixel(const Draw& draw, const Targets& targets, Driver driver)
      : draw_(draw),
        driver_(driver),
        setup_(make_fragment_setup(draw, targets, scalar_kernels(),
                                   *std::pmr::get_default_resource())),
        source_(to_rgba8(std::get<Flat>(draw.shading).color)) {}

  /// Calls reach(state after it, fate) for each outcome.
  template <class Reach>
  void run(const Fragment& fragment, const PixelState& state, const Reach& reach) const {
    const FragmentTests& tests = (fragment.front ? setup_.front : setup_.back).tests;
    PixelState failed = state;
    if (!test(tests, CompareFunc::always, failed.stencil)) {
      reach(failed, Fate::stencil_fail);
      return;
    }
    const May may =
        tests.depth_test ? compare_depths(tests.depth_func, fragment, state) : May{true, false};
    if (may.fail) {
      failed = state;
      test(tests, CompareFunc::never, failed.stencil);
      reach(failed, Fate::depth_fail);
    }
    if (!may.pass) return;
    PixelState passed = state;
    test(tests, CompareFunc::always, passed.stencil);
    if (tests.depth_write) {
      passed.depth_low = fragment.depth_low;
      passed.depth_high = fragment.depth_high;
    }
    passed.color = blend(state.color);
    reach(passed, Fate::pass);
  }

 private:
  /// Stencil test and update of one pixel, the depth test decided beforehand; false if the stencil
  /// test fails.
  static bool test(FragmentTests tests, CompareFunc depth, std::uint8_t& stencil) {
    tests.depth_test = true;
    tests.depth_write = false;
    tests.depth_func = depth;
    std::array<std::uint32_t, kPixelsPerBlock> depths{};
    std::array<std::uint8_t, kPixelsPerBlock> stencils{};
    stencils[0] = stencil;
    PixelMask pixel = 1;
    const bool passed =
        scalar_kernels().test_blocks(
            tests, {.blocks = 1, .depth = depths.data(), .stencil = stencils.data()}, &pixel) != 0;
    stencil = stencils[0];
    return passed;
  }

  Rgba8 blend(const Rgba8& stored) const {
    const ColorState& state = draw_.state.color;
    if (driver_ == Driver::llvmpipe) return llvmpipe_blend(state, source_, stored);
    const Rgba8 constant = state.blend ? to_rgba8(state.blend->constant) : Rgba8{};
    return blend_rgba8(state, constant, source_, stored);
  }

  const Draw& draw_;
  const Driver driver_;
  const FragmentSetup setup_;
  const Rgba8 source_;
};

bool culled(const State& state, bool front) {
  return state.cull == Cull::front_and_back || (state.cull == Cull::front && front) ||
         (state.cull == Cull::back && !front);
}

/// One draw's triangles, set up by both.
class Geometry {
 public:
  Geometry(const Draw& draw, const Targets& targets, Driver driver)
      : draw_(draw),
        setup_(make_draw_setup(draw, targets)),
        height_(targets.height()),
        rounding_(driver == Driver::llvmpipe ? DepthRounding::nearest : DepthRounding::down) {
    DrawVertices vertices;
    vertices.resize(draw.mesh.positions.size());
    std::vector<glm::vec4>& clip = vertices.clip;
    scalar_kernels().transform(draw.clip_from_model, draw.mesh.positions.data(), clip.size(),
                               clip.data());
    project_vertices(scalar_kernels(), setup_, vertices, 0, clip.size());
    for (std::size_t t = 0; t < draw.mesh.indices.size() / 3; ++t) {
      const auto index = draw.mesh.indices.subspan(3 * t, 3);
      SetupTriangles pieces;
      set_up_triangles(scalar_kernels(), setup_, vertices, t, 1, pieces);
      Both both{std::move(pieces.triangles),
                clipped_outline(setup_, {clip[index[0]], clip[index[1]], clip[index[2]]}, height_),
                {}};
      both.snap_only = both.outline;
      for (Corner& corner : both.snap_only) corner.error_px = 0.0;
      triangles_.push_back(std::move(both));
    }
  }

  std::vector<Site> at(int x, int y) const {
    std::vector<Site> sites;
    if (x < setup_.box.x0 || y < setup_.box.y0 || x >= setup_.box.x1 || y >= setup_.box.y1)
      return sites;
    for (const Both& both : triangles_) sites.push_back(site(both, x, y));
    return sites;
  }

 private:
  struct Both {
    std::vector<SetupTriangle> pieces;
    Outline outline;
    /// The same corners, free of float32's errors.
    Outline snap_only;
  };

  /// gnomon's depths are as far from llvmpipe's as the snap may bring them, and its polygon offset
  /// as far as the slopes are apart.
  bool own_depths_hold(const Both& both, const DepthBounds& bounds, int x, int y) const {
    const std::optional<PolygonOffset>& offset = draw_.state.polygon_offset;
    const double factor = offset ? std::abs(static_cast<double>(offset->factor)) : 0.0;
    return std::all_of(both.pieces.begin(), both.pieces.end(), [&](const SetupTriangle& piece) {
      if (!piece.covers(x, y)) return true;
      const double slope = std::max(units(piece.step_x), units(piece.step_y));
      const double apart =
          std::max(std::abs(slope - bounds.slope_low), std::abs(slope - bounds.slope_high));
      const double slack = bounds.slack + (factor > 0.0 ? factor * apart : 0.0);
      const double depth = piece.depth_at(x, y, setup_);
      return depth >= bounds.low - slack && depth <= bounds.high + slack;
    });
  }

  /// A slope's size, from 1/256 units modulo 2^64.
  static double units(std::uint64_t step) {
    return std::abs(static_cast<double>(static_cast<std::int64_t>(step))) / 256.0;
  }

  Site site(const Both& both, int x, int y) const {
    Site site;
    for (const SetupTriangle& piece : both.pieces) {
      if (!piece.covers(x, y)) continue;
      const std::uint32_t depth = piece.depth_at(x, y, setup_);
      site.own.push_back({piece.front_facing, depth, depth});
    }
    const glm::dvec2 center(x + 0.5, y + 0.5);
    const bool near = clearance_px(both.outline, center) <= 0.0;
    if (near)
      site.if_other = clearance_px(both.snap_only, center) <= 0.0 ? Coverage::snap : Coverage::cut;
    const bool inside = contains(both.outline, center);
    if (near || !inside) site.possible.push_back({});
    if (near || inside) {
      const bool front =
          (signed_area(both.outline) > 0.0) == (draw_.state.front_face == FrontFace::ccw);
      const DepthBounds depth = depth_bounds(setup_, both.outline, center, height_, rounding_);
      site.own_depths_hold = own_depths_hold(both, depth, x, y);
      if (!culled(draw_.state, front))
        site.possible.push_back({{front, depth.low, depth.high}});
      else if (!near)
        site.possible.push_back({});
    }
    return site;
  }

  const Draw& draw_;
  const DrawSetup setup_;
  const int height_;
  const DepthRounding rounding_;
  std::vector<Both> triangles_;
};

bool same_faces(const Fragments& a, const Fragments& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Fragment& x, const Fragment& y) { return x.front == y.front; });
}

/// What became of gnomon's own fragments, triangle by triangle.
std::vector<std::vector<Fate>> own_fates(const Pixel& pixel, const std::vector<Site>& sites,
                                         PixelState state) {
  std::vector<std::vector<Fate>> fates;
  for (const Site& site : sites) {
    fates.emplace_back();
    for (const Fragment& fragment : site.own)
      pixel.run(fragment, PixelState(state), [&](const PixelState& after, Fate fate) {
        state = after;
        fates.back().push_back(fate);
      });
  }
  return fates;
}

/// Every state that a set of possible fragments leads to.
void extend(const Pixel& pixel, const Fragments& fragments, bool same, const std::vector<Fate>& own,
            std::size_t done, const PixelState& state, std::vector<PixelState>& out) {
  if (done == fragments.size()) {
    if (std::find(out.begin(), out.end(), state) == out.end()) out.push_back(state);
    return;
  }
  pixel.run(fragments[done], state, [&](PixelState after, Fate fate) {
    if (same && own[done] != fate) after.other_fate = true;
    extend(pixel, fragments, same, own, done + 1, after, out);
  });
}

std::vector<PixelState> outcomes(const Pixel& pixel, const std::vector<Site>& sites,
                                 const PixelState& before) {
  const std::vector<std::vector<Fate>> fates = own_fates(pixel, sites, before);
  std::vector<PixelState> states{before};
  for (std::size_t t = 0; t < sites.size(); ++t) {
    std::vector<PixelState> next;
    for (const PixelState& state : states)
      for (const Fragments& fragments : sites[t].possible) {
        PixelState start = state;
        const bool same = same_faces(fragments, sites[t].own);
        if (!same) start.coverage = std::max(start.coverage, sites[t].if_other);
        extend(pixel, fragments, same, fates[t], 0, start, next);
      }
    states = std::move(next);
  }
  return states;
}

Rgba8 color_at(const Buffers& buffers, std::size_t i) {
  const std::uint8_t* c = buffers.color.data() + 4 * i;
  return {c[0], c[1], c[2], c[3]};
}

Differing difference_at(const Buffers& a, const Buffers& b, std::size_t i) {
  Differing out;
  out.stencil = a.stencil[i] != b.stencil[i];
  out.depth = a.depth[i] != b.depth[i];
  const Rgba8 x = color_at(a, i), y = color_at(b, i);
  for (std::size_t c = 0; c < 4; ++c) out.color += x[c] != y[c];
  return out;
}

/// Units by which two evaluations of one plane differ where its slope has no part in it: each is
/// within one of the rounded rational depth.
constexpr std::uint32_t kLevel = 2;

std::uint32_t depth_distance(const DrawStep& step, std::size_t i) {
  const std::uint32_t a = step.after.depth[i], b = step.after_gl.depth[i];
  return a > b ? a - b : b - a;
}

/// Two products rounded one by one and their sum rounded once are at most 2 apart, a fragment.
bool blend_explains(const Draw& draw, const std::vector<Site>& sites, const DrawStep& step,
                    std::size_t i) {
  const Rgba8 ours = color_at(step.after, i), theirs = color_at(step.after_gl, i);
  int fragments = 0, distance = 0;
  for (const Site& site : sites) fragments += static_cast<int>(site.own.size());
  for (std::size_t c = 0; c < 4; ++c)
    distance = std::max(distance, std::abs(int{ours[c]} - int{theirs[c]}));
  return distance == 0 || (draw.state.color.blend && distance <= 2 * fragments);
}

/// Puts a pixel's differing values under the class of the simplest history that leads to OpenGL's.
/// False if there is none.
bool classify(const Draw& draw, const std::vector<Site>& sites,
              const std::vector<PixelState>& states, const DrawStep& step, std::size_t i,
              DrawCauses& causes) {
  const Differing differing = difference_at(step.after, step.after_gl, i);
  const PixelState* best = nullptr;
  const auto rank = [](const PixelState& s) {
    return 2 * static_cast<int>(s.coverage) + s.other_fate;
  };
  for (const PixelState& s : states)
    if (s.stencil == step.after_gl.stencil[i] && s.depth_low <= step.after_gl.depth[i] &&
        step.after_gl.depth[i] <= s.depth_high && s.color == color_at(step.after_gl, i) &&
        (!best || rank(s) < rank(*best)))
      best = &s;
  const bool possible =
      best && best->coverage != Coverage::impossible &&
      std::all_of(sites.begin(), sites.end(), [](const Site& s) { return s.own_depths_hold; });
  if (!possible) {
    causes.unexplained += differing;
    return false;
  }
  if (best->coverage == Coverage::cut) {
    causes.cut += differing;
  } else if (best->coverage == Coverage::snap) {
    causes.snap += differing;
  } else if (best->other_fate) {
    causes.tie += differing;
  } else if (differing.stencil == 0 && blend_explains(draw, sites, step, i)) {
    (depth_distance(step, i) <= kLevel ? causes.plane : causes.steep).depth += differing.depth;
    causes.blend.color += differing.color;
  } else {
    causes.unexplained += differing;
    return false;
  }
  return true;
}

}  // namespace

DrawCauses& DrawCauses::operator+=(const DrawCauses& other) {
  snap += other.snap;
  cut += other.cut;
  tie += other.tie;
  plane += other.plane;
  steep += other.steep;
  blend += other.blend;
  unexplained += other.unexplained;
  return *this;
}

DrawExplanation explain_draw(const Draw& draw, const Targets& targets, const DrawStep& step) {
  DrawExplanation out;
  const Geometry geometry(draw, targets, step.driver);
  const Pixel pixel(draw, targets, step.driver);
  for (std::size_t i = 0; i < step.after.stencil.size(); ++i) {
    if (difference_at(step.after, step.after_gl, i).all() == 0) continue;
    const int x = static_cast<int>(i) % step.width, y = static_cast<int>(i) / step.width;
    const PixelState before{step.before.stencil[i], step.before.depth[i], step.before.depth[i],
                            color_at(step.before, i)};
    const std::vector<Site> sites = geometry.at(x, y);
    const std::vector<PixelState> states = outcomes(pixel, sites, before);
    if (!classify(draw, sites, states, step, i, out.causes) && !out.unexplained_pixel)
      out.unexplained_pixel = i;
  }
  return out;
}

}  // namespace gnomon::peer
