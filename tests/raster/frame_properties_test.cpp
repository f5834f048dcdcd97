// What must hold of every frame, whatever it draws (oracle: invariants, each stated at its test).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include "closed_meshes.h"
#include "isa_test.h"
#include "random_frames.h"
#include "small_frames.h"

using namespace gnomon::raster;
using namespace gnomon::small_frames;
using gnomon::random_frames::Random;
using gnomon::random_frames::record_pass;
using Buffers = gnomon::random_frames::Targets;

namespace {

class Moving : public gnomon::IsaTest {};
class EqualDepth : public gnomon::IsaTest {};
class Parts : public gnomon::IsaTest {};

/// Records the commands of a frame again, each as the commands that `change` makes of it.
template <class Change>
void record_again(Frame& out, const Frame& frame, Change change) {
  for (const Pass& pass : frame.passes()) {
    out.begin_pass(pass.label, pass.targets);
    for (const Command& command : pass.commands)
      for (const Command& changed : change(command)) {
        if (const Clear* clear = std::get_if<Clear>(&changed)) out.clear(*clear);
        if (const Draw* draw = std::get_if<Draw>(&changed)) out.draw(*draw);
        if (const Blit* blit = std::get_if<Blit>(&changed)) out.blit(*blit);
      }
  }
}

Rect intersection(const Rect& a, const Rect& b) {
  const int x0 = std::max(a.x, b.x), y0 = std::max(a.y, b.y);
  const int x1 = std::min(a.x + a.width, b.x + b.width);
  const int y1 = std::min(a.y + a.height, b.y + b.height);
  return {x0, y0, std::max(x1 - x0, 0), std::max(y1 - y0, 0)};
}

}  // namespace

GNOMON_ON_EVERY_ISA(Moving);
GNOMON_ON_EVERY_ISA(EqualDepth);
GNOMON_ON_EVERY_ISA(Parts);

namespace {

/// The picture that is moved about in a larger target.
constexpr Rect kPicture{0, 0, 100, 83};

/// The frame again with its whole picture at (x, y) of its targets. With `depth_decides` off no
/// depth test can fail.
void record_at(Frame& out, const Frame& frame, int x, int y, bool depth_decides) {
  const auto moved = [&](const std::optional<Rect>& scissor) {
    Rect rect = scissor ? intersection(kPicture, *scissor) : kPicture;
    rect.x += x;
    rect.y += y;
    return rect;
  };
  record_again(out, frame, [&](const Command& command) {
    Command changed = command;
    if (Clear* clear = std::get_if<Clear>(&changed)) clear->scissor = moved(clear->scissor);
    if (Blit* blit = std::get_if<Blit>(&changed)) {
      blit->x += x;
      blit->y += y;
      blit->scissor = moved(blit->scissor);
    }
    if (Draw* draw = std::get_if<Draw>(&changed)) {
      Rect viewport = draw->state.viewport.value_or(kPicture);
      viewport.x += x;
      viewport.y += y;
      draw->state.viewport = viewport;
      draw->state.scissor = moved(draw->state.scissor);
      if (!depth_decides && draw->state.depth) draw->state.depth->func = CompareFunc::always;
    }
    return std::array{changed};
  });
}

/// Buffers that hold what `from` holds, (dx, dy) pixels further; what comes from outside is as new.
Buffers moved_by(const Buffers& from, int dx, int dy) {
  const int width = from.depth.width(), height = from.depth.height();
  Buffers to(width, height, from.color.format(), from.depth.format());
  for (int y = dy; y < height; ++y)
    for (int x = dx; x < width; ++x) {
      to.depth.plane().at(x, y) = from.depth.at(x - dx, y - dy);
      to.stencil.plane().at(x, y) = from.stencil.at(x - dx, y - dy);
      if (from.color.format() == ColorFormat::rgba8)
        to.color.rgba8().at(x, y) = from.color.rgba8().at(x - dx, y - dy);
      else
        to.color.rgba32f().at(x, y) = from.color.rgba32f().at(x - dx, y - dy);
    }
  return to;
}

/// One random frame with its picture at (x, y).
Buffers drawn_at(std::uint32_t seed, int x, int y, bool depth_decides,
                 const ExecuteOptions& options) {
  Buffers buffers(240, 210, seed % 3 ? ColorFormat::rgba8 : ColorFormat::rgba32f,
                  seed % 2 ? DepthFormat::d24 : DepthFormat::d16);
  Frame frame, moved;
  record_pass(frame, seed, 12, buffers.all());
  record_at(moved, frame, x, y, depth_decides);
  execute(moved, options);
  return buffers;
}

}  // namespace

// Moving by whole tiles moves every byte of all three buffers, whatever the state: each tile's
// depth planes are re-based as they were.
TEST_P(Moving, ByWholeTilesMovesEveryByte) {
  for (std::uint32_t seed = 1; seed <= 24; ++seed) {
    Random random(seed);
    const int x = random.integer(0, 70), y = random.integer(0, 60);
    const int dx = seed % 2 ? 64 : 0, dy = seed % 2 == 0 || seed % 3 == 0 ? 64 : 0;
    const auto run = options(static_cast<int>(seed));
    const Buffers here = drawn_at(seed, x, y, true, run);
    const Buffers there = drawn_at(seed, x + dx, y + dy, true, run);
    ASSERT_EQ(there.bytes(), moved_by(here, dx, dy).bytes()) << "seed " << seed;
  }
}

// Moving by whole pixels moves coverage and colour, and with them stencil and colour where no depth
// test decides, to the bit. Depth planes begin at another pixel of another tile, where their slopes
// are rounded into other sums: depths stay within one unit.
TEST_P(Moving, ByWholePixelsMovesColourAndStencilAndLeavesDepthWithinAUnit) {
  for (std::uint32_t seed = 1001; seed <= 1024; ++seed) {
    Random random(seed);
    const int x = random.integer(0, 70), y = random.integer(0, 60);
    const int dx = random.integer(0, 70), dy = random.integer(0, 67);
    const auto run = options(static_cast<int>(seed));
    Buffers expected = moved_by(drawn_at(seed, x, y, false, run), dx, dy);
    const Buffers there = drawn_at(seed, x + dx, y + dy, false, run);
    for (int v = 0; v < 210; ++v)
      for (int u = 0; u < 240; ++u) {
        const auto a = static_cast<std::int64_t>(expected.depth.at(u, v));
        const auto b = static_cast<std::int64_t>(there.depth.at(u, v));
        ASSERT_LE(std::abs(a - b), 1) << "seed " << seed << " at " << u << ' ' << v;
      }
    expected.depth = there.depth;
    ASSERT_EQ(there.bytes(), expected.bytes()) << "seed " << seed;
  }
}

namespace {

/// Loose triangles of every depth, some cut off, each a draw with a number from 1 as its stencil
/// reference and a colour of its own.
struct Numbered {
  std::vector<std::array<glm::vec4, 3>> triangles;
  std::vector<glm::vec4> colors;

  explicit Numbered(Random& random) {
    for (int i = random.integer(20, 250); i > 0; --i) {
      std::array<glm::vec4, 3> triangle;
      const float x = random.real(-1.2f, 1.2f), y = random.real(-1.2f, 1.2f);
      const float size = random.chance(0.2f) ? 2.0f : 0.3f;
      for (glm::vec4& p : triangle) {
        const float w = random.chance(0.05f) ? random.real(-1.0f, 0.0f) : random.real(0.2f, 3.0f);
        const float dx = random.real(-size, size), dy = random.real(-size, size);
        p = {(x + dx) * w, (y + dy) * w, random.real(-1.1f, 1.1f) * w, w};
      }
      triangles.push_back(triangle);
      const float r = random.real(0, 1), g = random.real(0, 1);
      colors.push_back({r, g, random.real(0, 1), 1});
    }
  }

  void draw(Frame& frame, const State& state, std::size_t i) const {
    static constexpr std::array<std::uint32_t, 3> kIndices{0, 1, 2};
    frame.draw({.state = state,
                .mesh = {.positions = triangles[i], .indices = kIndices},
                .shading = Flat{colors[i]},
                .stencil_ref = static_cast<int>(i) + 1});
  }
};

/// A depth test, range, clamp and offset; the cleared depth that every fragment passes is 1 for
/// less and less_equal, 0 for the others.
State random_depth_state(Random& random, CompareFunc func) {
  State state;
  StencilFace number;
  number.pass = StencilOp::replace;
  state.stencil = StencilState::both(number);
  state.depth = DepthState{func, true};
  // No fragment lies at a cleared depth, where it would not pass `less` but is equal.
  state.depth_range = random.chance(0.5f) ? DepthRange{0.125f, 0.75f} : DepthRange{0.875f, 0.25f};
  state.depth_clamp = random.chance(0.5f);
  if (state.depth_clamp || random.chance(0.5f))
    state.polygon_offset = PolygonOffset{random.real(-2.0f, 2.0f), random.real(-90.0f, 90.0f)};
  if (!state.depth_clamp && state.polygon_offset) state.polygon_offset->factor = 0.0f;
  return state;
}

}  // namespace

// Drawing everything again with EQUAL, depth as it was left, hits at each pixel exactly the
// fragment that is seen there: numbers and colours come out the same. Of fragments that tie, less
// and greater keep the first, the others the last, so the second pass goes the same way round.
TEST_P(EqualDepth, DrawsThePictureAgain) {
  Random random(11);
  int drawn = 0;
  for (int round = 0; round < 48; ++round) {
    const std::array<CompareFunc, 4> funcs{CompareFunc::less, CompareFunc::less_equal,
                                           CompareFunc::greater, CompareFunc::greater_equal};
    const CompareFunc func = funcs[static_cast<std::size_t>(round % 4)];
    const bool first_wins = func == CompareFunc::less || func == CompareFunc::greater;
    const bool nearer = func == CompareFunc::less || func == CompareFunc::less_equal;
    const Numbered numbered(random);
    const std::size_t count = numbered.triangles.size();
    State state = random_depth_state(random, func);
    const auto format = round % 8 < 4 ? DepthFormat::d24 : DepthFormat::d16;
    Buffers seen(120, 90, ColorFormat::rgba8, format), again = seen, whole = seen;
    Frame frame;
    frame.begin_pass("seen", seen.all());
    frame.clear({.depth = nearer ? 1.0f : 0.0f});
    for (std::size_t i = 0; i < count; ++i) numbered.draw(frame, state, i);

    state.depth = DepthState{CompareFunc::equal, false};
    frame.begin_pass("again", {&again.color, &seen.depth, &again.stencil});
    for (std::size_t i = 0; i < count; ++i)
      numbered.draw(frame, state, first_wins ? count - 1 - i : i);

    // The whole as one draw: what is drawn at all, is hit.
    state.stencil->front.pass = state.stencil->back.pass = StencilOp::incr;
    frame.begin_pass("whole", {.depth = &seen.depth, .stencil = &whole.stencil});
    std::vector<glm::vec4> positions;
    for (const auto& triangle : numbered.triangles)
      positions.insert(positions.end(), triangle.begin(), triangle.end());
    draw_positions(frame, state, positions);
    execute(frame, options(round));

    ASSERT_EQ(again.stencil.to_rows(), seen.stencil.to_rows()) << "round " << round;
    ASSERT_EQ(again.color.to_rgba8_rows(), seen.color.to_rgba8_rows()) << "round " << round;
    const auto numbers = seen.stencil.to_rows(), hits = whole.stencil.to_rows();
    for (std::size_t i = 0; i < hits.size(); ++i)
      ASSERT_EQ(hits[i] != 0, numbers[i] != 0) << "round " << round << ", pixel " << i;
    drawn += static_cast<int>(hits.size()) -
             static_cast<int>(std::count(numbers.begin(), numbers.end(), 0));
  }
  EXPECT_GT(drawn, 100000);
}

namespace {

/// The buffers of a frame whose passes differ in size, format and attachments.
struct PassBuffers {
  Buffers large{130, 70, ColorFormat::rgba8, DepthFormat::d24};
  Buffers small{9, 66, ColorFormat::rgba32f, DepthFormat::d16};
  ColorBuffer other{130, 70};

  Frame record(std::uint32_t seed) {
    Frame frame;
    for (std::uint32_t pass = 0; pass < 3; ++pass) {
      record_pass(frame, seed + 100 * pass, 8, large.all());
      record_pass(frame, seed + 100 * pass + 20, 5, small.all());
      record_pass(frame, seed + 100 * pass + 40, 5, {&other, &large.depth, &large.stencil});
    }
    return frame;
  }

  std::vector<std::uint8_t> bytes() const {
    std::vector<std::uint8_t> all = large.bytes();
    for (const std::uint8_t b : small.bytes()) all.push_back(b);
    for (const std::uint8_t b : other.to_rgba8_rows()) all.push_back(b);
    return all;
  }
};

/// The draw in pieces of consecutive triangles, cut at random; or the command as it is.
std::vector<Command> cut_in_pieces(Random& random, const Command& command) {
  const Draw* draw = std::get_if<Draw>(&command);
  if (!draw) return {command};
  std::vector<Command> pieces;
  const int triangles = static_cast<int>(draw->mesh.indices.size() / 3);
  for (int first = 0, last = 0; first < triangles; first = last) {
    last = random.integer(first + 1, triangles);
    Draw piece = *draw;
    piece.mesh.indices = draw->mesh.indices.subspan(static_cast<std::size_t>(first) * 3,
                                                    static_cast<std::size_t>(last - first) * 3);
    pieces.push_back(piece);
  }
  return pieces;
}

}  // namespace

// A mesh drawn in any number of pieces, its triangles in the same order, leaves the bytes of one
// draw, with every state.
TEST_P(Parts, AMeshInPiecesLeavesTheBytesOfTheWhole) {
  for (std::uint32_t seed = 1; seed <= 16; ++seed) {
    Random random(seed);
    const auto run = options(static_cast<int>(seed));
    PassBuffers whole, pieces;
    execute(whole.record(seed), run);
    const Frame frame = pieces.record(seed);
    Frame cut;
    record_again(cut, frame, [&](const Command& c) { return cut_in_pieces(random, c); });
    ASSERT_GT(cut.command_count(), frame.command_count());
    execute(cut, run);
    ASSERT_EQ(pieces.bytes(), whole.bytes()) << "seed " << seed;
  }
}

// The same for more triangles than the front end sets up at a time.
TEST_P(Parts, ALargeMeshInPiecesLeavesTheBytesOfTheWhole) {
  Random random(31);
  const auto mesh = gnomon::closed_meshes::dented_sphere(random, 4);
  std::vector<glm::vec4> colors;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    colors.push_back({random.real(0, 1), random.real(0, 1), random.real(0, 1), 1});
  State state = signed_counting();
  state.color = {};
  state.depth = DepthState{};
  for (int round = 0; round < 5; ++round) {
    Buffers whole(130, 100, ColorFormat::rgba32f, DepthFormat::d24), pieces = whole;
    Frame frame, cut;
    frame.begin_pass("sphere", whole.all());
    frame.draw({.state = state,
                .mesh = {.positions = mesh.positions, .indices = mesh.indices, .colors = colors}});
    cut.begin_pass("sphere", pieces.all());
    for (const Command& piece : cut_in_pieces(random, frame.passes()[0].commands[0]))
      cut.draw(std::get<Draw>(piece));
    execute(frame, options(round));
    execute(cut, options(round));
    ASSERT_EQ(pieces.bytes(), whole.bytes()) << "round " << round;
  }
}

// A frame executed in any number of calls, its commands in order, leaves the bytes of one call,
// even where each call runs on another instruction set.
TEST_P(Parts, AFrameInSeveralCallsLeavesTheBytesOfOne) {
  const auto isas = available_isas();
  for (std::uint32_t seed = 501; seed <= 514; ++seed) {
    Random random(seed);
    PassBuffers whole, parts;
    execute(whole.record(seed), options(static_cast<int>(seed)));
    const Frame frame = parts.record(seed);
    const int count = static_cast<int>(frame.command_count());
    for (int first = 0, last = 0; first < count; first = last) {
      last = random.integer(first, count);
      ExecuteOptions run = options(last);
      if (seed % 2)
        run.isa =
            isas[static_cast<std::size_t>(random.integer(0, static_cast<int>(isas.size()) - 1))];
      run.first_command = static_cast<std::size_t>(first);
      run.commands = static_cast<std::size_t>(last);
      execute(frame, run);
    }
    ASSERT_EQ(parts.bytes(), whole.bytes()) << "seed " << seed;
  }
}

// Stopped before command k, a frame leaves the bytes of a frame in which nothing but its first k
// commands was recorded.
TEST_P(Parts, UpToACommandAFrameLeavesTheBytesOfItsFirstCommandsAlone) {
  for (std::uint32_t seed = 601; seed <= 614; ++seed) {
    PassBuffers stopped, alone;
    const Frame frame = stopped.record(seed), long_frame = alone.record(seed);
    const auto k =
        static_cast<std::size_t>(Random(seed).integer(0, static_cast<int>(frame.command_count())));
    Frame first;
    record_again(first, long_frame, [&](const Command& command) {
      return first.command_count() < k ? std::vector{command} : std::vector<Command>{};
    });
    ASSERT_EQ(first.command_count(), k);
    ExecuteOptions run = options(static_cast<int>(seed));
    execute(first, run);
    run.commands = k;
    execute(frame, run);
    ASSERT_EQ(stopped.bytes(), alone.bytes()) << "seed " << seed << ", " << k << " commands";
  }
}
