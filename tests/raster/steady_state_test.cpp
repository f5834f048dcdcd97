// A frame executed again and again with one ExecuteMemory allocates nothing after the first time.
// Counts calls of operator new, so this is a program of its own; what oneTBB keeps for itself is
// not counted.
#include <atomic>
#include <cstdlib>
#include <new>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "raster/execute.h"

namespace {

std::atomic<long> allocations{0};

void* counted(std::size_t size) {
  ++allocations;
  if (void* const memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t size) { return counted(size); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  ++allocations;
  const auto step = static_cast<std::size_t>(alignment);
  if (void* const memory = std::aligned_alloc(step, (size + step - 1) / step * step)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace gnomon::raster {
namespace {

/// A grid of triangles that reaches beyond every clip plane.
struct Grid {
  std::vector<glm::vec4> positions;
  std::vector<glm::vec3> normals;
  std::vector<std::uint32_t> indices;

  Grid() {
    constexpr std::uint32_t kSide = 40;
    for (std::uint32_t y = 0; y < kSide; ++y)
      for (std::uint32_t x = 0; x < kSide; ++x) {
        const float u = static_cast<float>(3 * x) / kSide - 1.5f;
        const float v = static_cast<float>(3 * y) / kSide - 1.5f;
        positions.emplace_back(u, v, u * v, 1.0f + 0.5f * u);
        normals.emplace_back(u, v, 1.0f);
      }
    for (std::uint32_t y = 0; y + 1 < kSide; ++y)
      for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
        const std::uint32_t a = y * kSide + x, b = a + 1, c = a + kSide, d = c + 1;
        for (const std::uint32_t index : {a, b, d, a, d, c}) indices.push_back(index);
      }
  }
};

class SteadyState : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Threads, SteadyState, ::testing::Values(1, 2, 5));

TEST_P(SteadyState, AllocatesNothing) {
  if (GetParam() > 1 && std::string_view(GNOMON_EXECUTOR) == "threads")
    GTEST_SKIP() << "this executor starts its threads for each call";
  const Grid grid;
  ColorBuffer color(300, 200);
  DepthBuffer depth(300, 200), map(100, 100);
  StencilBuffer stencil(300, 200);
  const Targets targets{&color, &depth, &stencil};
  const MeshView mesh{
      .positions = grid.positions, .indices = grid.indices, .normals = grid.normals};
  Frame frame;
  frame.begin_pass("map", {.depth = &map});
  frame.clear({.depth = 1.0f});
  frame.draw({.state = {.depth = DepthState{}}, .mesh = mesh});
  frame.begin_pass("lit", targets);
  frame.clear({.color = glm::vec4(0.0f), .depth = 1.0f, .stencil = 0});
  Lit lit;
  lit.lights.resize(3);
  frame.draw({.state = {.depth = DepthState{}}, .mesh = mesh, .shading = lit});
  lit.at_vertices = true;
  frame.draw({.state = {.depth = DepthState{}}, .mesh = mesh, .shading = lit});
  lit.two_sided = true;
  frame.draw({.state = {.depth = DepthState{}}, .mesh = mesh, .shading = lit});
  frame.begin_pass("counts", targets);
  const StencilState counts = StencilState::both({.depth_fail = StencilOp::incr_wrap});
  frame.draw({.state = {.depth = DepthState{.write = false}, .stencil = counts}, .mesh = mesh});

  ExecuteMemory memory;
  const ExecuteOptions options{.threads = GetParam(), .memory = &memory};
  // The second time a thread may meet a chunk that is new to it.
  for (int i = 0; i < 3; ++i) execute(frame, options);
  const long before = allocations;
  for (int i = 0; i < 10; ++i) execute(frame, options);
  EXPECT_EQ(allocations - before, 0);
}

}  // namespace
}  // namespace gnomon::raster
