// Commands are run in groups: all passes in a row whose targets have one size, cut where a group's
// set-up triangles would take too much memory. Inside a group the front end sets up every draw's
// triangles and bins them, then each tile runs all commands of all passes while its pixels are in
// cache.
#include "raster/execute.h"

#include <algorithm>

#include "raster/check.h"
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
  Targets targets;
  DrawSetup setup;
  std::vector<std::vector<SetupTriangle>> chunks;
  std::vector<std::vector<const SetupTriangle*>> bins;
};

void set_up_draw(Job& job, int threads) {
  const Draw& draw = std::get<Draw>(*job.command);
  job.setup = make_draw_setup(draw, job.targets);
  std::vector<glm::vec4> clip(draw.mesh.positions.size());
  for_each_chunk(clip.size(), kVerticesPerChunk, threads, [&](std::size_t first, std::size_t last) {
    transform_vertices(draw, first, std::span(clip).subspan(first, last - first));
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

void run_tile(const std::vector<Job>& jobs, std::size_t tile, const Size& size) {
  const TileIndex index{static_cast<int>(tile) % size.tiles_x(),
                        static_cast<int>(tile) / size.tiles_x()};
  for (const Job& job : jobs) {
    if (const Clear* clear = std::get_if<Clear>(job.command)) {
      clear_tile(*clear, job.targets, index);
    } else if (const Blit* blit = std::get_if<Blit>(job.command)) {
      blit_tile(*blit, job.targets, index);
    } else {
      for (const SetupTriangle* triangle : job.bins[tile])
        draw_tile(job.setup, *triangle, job.targets, index);
    }
  }
}

std::size_t triangles_of(const Command& command) {
  const Draw* draw = std::get_if<Draw>(&command);
  return draw ? draw->mesh.indices.size() / 3 : 0;
}

void run_group(std::vector<Job>& jobs, const Size& size, int threads) {
  for (Job& job : jobs)
    if (std::holds_alternative<Draw>(*job.command)) set_up_draw(job, threads);
  for_each_chunk(jobs.size(), 1, threads, [&](std::size_t first, std::size_t) {
    if (std::holds_alternative<Draw>(*jobs[first].command)) bin_draw(jobs[first], size);
  });
  const std::size_t tiles = static_cast<std::size_t>(size.tiles_x()) * size.tiles_y();
  for_each_chunk(tiles, 1, threads,
                 [&](std::size_t first, std::size_t) { run_tile(jobs, first, size); });
}

}  // namespace

void execute(const Frame& frame, const ExecuteOptions& options) {
  require(options.threads >= 0, "a number of threads is not negative");
  std::vector<Job> jobs;
  Size size;
  std::size_t number = 0, triangles = 0;
  const auto finish_group = [&] {
    run_group(jobs, size, options.threads);
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
      jobs.push_back({&command, pass.targets, {}, {}, {}});
      triangles += triangles_of(command);
      if (triangles >= kTrianglesPerGroup || jobs.size() >= kCommandsPerGroup) finish_group();
    }
  }
  finish_group();
}

}  // namespace gnomon::raster
