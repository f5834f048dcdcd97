// Commands are run in groups: all passes in a row whose targets have one size, cut where a depth
// buffer that was drawn into is looked up, and where a group's set-up triangles would take too much
// memory. Inside a group the front end sets up every draw's
// triangles and bins them, then each tile runs all commands of all passes while its pixels are in
// cache.
#include "raster/execute.h"

#include <algorithm>

#include "raster/block_ranges.h"
#include "raster/check.h"
#include "raster/draw_tile.h"
#include "raster/executor.h"
#include "raster/geometry.h"
#include "raster/tile.h"

namespace gnomon::raster {

namespace {

constexpr std::size_t kVerticesPerChunk = 4096;
constexpr std::size_t kTrianglesPerChunk = 1024;
/// A group ends when its draws have so many triangles (a set-up triangle takes some 300 bytes), or
/// so many commands (a bin a tile each).
constexpr std::size_t kTrianglesPerGroup = std::size_t{1} << 21, kCommandsPerGroup = 512;

struct Size {
  int width = 0, height = 0;
  bool operator==(const Size&) const = default;
  int tiles_x() const { return (width + kTileSize - 1) / kTileSize; }
  int tiles_y() const { return (height + kTileSize - 1) / kTileSize; }
};

Size size_of(const Targets& targets) { return {targets.width(), targets.height()}; }

/// A command with its pass's targets; for a draw also its set-up triangles and, a tile, the numbers
/// of those that touch it.
struct Job {
  const Command* command = nullptr;
  Targets targets = {};
  DrawSetup setup = {};
  FragmentSetup fragments = {};
  std::vector<std::vector<SetupTriangle>> chunks = {};
  std::vector<std::vector<const SetupTriangle*>> bins = {};
};

void set_up_draw(Job& job, const Kernels& kernels, int threads) {
  const Draw& draw = std::get<Draw>(*job.command);
  job.setup = make_draw_setup(draw, job.targets);
  job.fragments = make_fragment_setup(draw, job.targets);
  std::vector<glm::vec4> clip(draw.mesh.positions.size());
  for_each_chunk(clip.size(), kVerticesPerChunk, threads, [&](std::size_t first, std::size_t last) {
    kernels.transform(draw.clip_from_model, draw.mesh.positions.data() + first, last - first,
                      clip.data() + first);
  });
  const std::size_t triangles = draw.mesh.indices.size() / 3;
  job.chunks.resize((triangles + kTrianglesPerChunk - 1) / kTrianglesPerChunk);
  for_each_chunk(triangles, kTrianglesPerChunk, threads, [&](std::size_t first, std::size_t last) {
    set_up_triangles(job.setup, clip, first, last - first, job.chunks[first / kTrianglesPerChunk]);
  });
}

/// True unless one edge keeps the whole tile out.
bool touches_tile(const SetupTriangle& triangle, int tile_x, int tile_y) {
  constexpr std::int64_t kSpan = (kTileSize - 1) * 256;
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const std::int64_t corner = triangle.edge(k, tile_x * std::int64_t{kTileSize * 256} + 128,
                                              tile_y * std::int64_t{kTileSize * 256} + 128);
    const std::int64_t highest = corner + std::max<std::int64_t>(triangle.a[i], 0) * kSpan +
                                 std::max<std::int64_t>(triangle.b[i], 0) * kSpan;
    if (highest < triangle.bias[i]) return false;
  }
  return true;
}

void bin_draw(Job& job, const Size& size) {
  job.bins.resize(static_cast<std::size_t>(size.tiles_x()) * size.tiles_y());
  for (const std::vector<SetupTriangle>& chunk : job.chunks)
    for (const SetupTriangle& triangle : chunk) {
      const PixelBox& box = triangle.box;
      for (int ty = box.y0 / kTileSize; ty <= (box.y1 - 1) / kTileSize; ++ty)
        for (int tx = box.x0 / kTileSize; tx <= (box.x1 - 1) / kTileSize; ++tx)
          if (touches_tile(triangle, tx, ty))
            job.bins[static_cast<std::size_t>(ty) * size.tiles_x() + tx].push_back(&triangle);
    }
}

void run_tile(const std::vector<Job>& jobs, const Kernels& kernels, std::size_t tile,
              const Size& size) {
  const TileIndex index{static_cast<int>(tile) % size.tiles_x(),
                        static_cast<int>(tile) / size.tiles_x()};
  BlockRanges ranges;
  for (const Job& job : jobs) {
    ranges.use(job.targets.depth);
    if (const Clear* clear = std::get_if<Clear>(job.command)) {
      clear_tile(kernels, *clear, job.targets, index);
      ranges.forget_all();
    } else if (const Blit* blit = std::get_if<Blit>(job.command)) {
      blit_tile(kernels, *blit, job.targets, index);
    } else {
      for (const SetupTriangle* triangle : job.bins[tile])
        draw_tile(kernels, job.setup, job.fragments, *triangle, job.targets, index, ranges);
    }
  }
}

std::size_t triangles_of(const Command& command) {
  const Draw* draw = std::get_if<Draw>(&command);
  return draw ? draw->mesh.indices.size() / 3 : 0;
}

/// Calls body(map) for each depth buffer that a command looks up.
template <class Body>
void for_each_map(const Command& command, Body body) {
  const Draw* draw = std::get_if<Draw>(&command);
  if (!draw) return;
  if (const Flat* flat = std::get_if<Flat>(&draw->shading)) {
    if (flat->depth_lookup) body(flat->depth_lookup->map);
    return;
  }
  for (const Light& light : std::get<Lit>(draw->shading).lights)
    if (light.shadow_map) body(light.shadow_map->map);
}

/// A tile may run ahead of others inside a group, so a group neither draws into a depth buffer that
/// it looks up nor the other way round.
bool must_wait(const std::vector<Job>& jobs, const Command& command, const Targets& targets) {
  bool wait = false;
  for_each_map(command, [&](const DepthBuffer* map) {
    for (const Job& job : jobs) wait = wait || job.targets.depth == map;
  });
  if (!targets.depth) return wait;
  for (const Job& job : jobs)
    for_each_map(*job.command,
                 [&](const DepthBuffer* map) { wait = wait || map == targets.depth; });
  return wait;
}

void run_group(std::vector<Job>& jobs, const Size& size, const Kernels& kernels, int threads) {
  for (Job& job : jobs)
    if (std::holds_alternative<Draw>(*job.command)) set_up_draw(job, kernels, threads);
  for_each_chunk(jobs.size(), 1, threads, [&](std::size_t first, std::size_t) {
    if (std::holds_alternative<Draw>(*jobs[first].command)) bin_draw(jobs[first], size);
  });
  const std::size_t tiles = static_cast<std::size_t>(size.tiles_x()) * size.tiles_y();
  for_each_chunk(tiles, 1, threads,
                 [&](std::size_t first, std::size_t) { run_tile(jobs, kernels, first, size); });
}

}  // namespace

void execute(const Frame& frame, const ExecuteOptions& options) {
  require(options.threads >= 0, "a number of threads is not negative");
  const Kernels& kernels = raster::kernels(options.isa);
  std::vector<Job> jobs;
  Size size;
  std::size_t number = 0, triangles = 0;
  const auto finish_group = [&] {
    run_group(jobs, size, kernels, options.threads);
    jobs.clear();
    triangles = 0;
  };
  for (const Pass& pass : frame.passes()) {
    if (size_of(pass.targets) != size) {
      finish_group();
      size = size_of(pass.targets);
    }
    for (const Command& command : pass.commands) {
      const bool wanted = number >= options.first_command && number < options.commands;
      ++number;
      if (!wanted) continue;
      if (must_wait(jobs, command, pass.targets)) finish_group();
      jobs.push_back({.command = &command, .targets = pass.targets});
      triangles += triangles_of(command);
      if (triangles >= kTrianglesPerGroup || jobs.size() >= kCommandsPerGroup) finish_group();
    }
  }
  finish_group();
}

}  // namespace gnomon::raster
