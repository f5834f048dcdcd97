// Commands are run in groups: all passes in a row whose targets have one size, cut where a depth
// buffer that was drawn into is looked up, and where a group's set-up triangles would take too much
// memory. Inside a group the front end brings all vertices to the window and lights those that are
// lit at vertices, then sets up and bins all triangles, then each tile runs all commands of all
// passes while its pixels are in cache.
#include "raster/execute.h"

#include <algorithm>
#include <functional>
#include <memory_resource>
#include <optional>
#include <vector>

#include "raster/check.h"
#include "raster/draw_geometry.h"
#include "raster/draw_tile.h"
#include "raster/executor.h"
#include "raster/lit_vertices.h"
#include "raster/looked_up.h"
#include "raster/lookup_bounds.h"
#include "raster/tile.h"

namespace gnomon::raster {

namespace {

constexpr std::size_t kVerticesPerPiece = 2048;
/// A group ends when its draws have so many triangles (a set-up triangle takes 96 bytes), or
/// so many commands.
constexpr std::size_t kTrianglesPerGroup = std::size_t{1} << 21, kCommandsPerGroup = 512;

struct Size {
  int width = 0, height = 0;
  bool operator==(const Size&) const = default;
  int tiles_x() const { return (width + kTileSize - 1) / kTileSize; }
  int tiles_y() const { return (height + kTileSize - 1) / kTileSize; }
};

Size size_of(const Targets& targets) { return {targets.width(), targets.height()}; }

/// A command with its pass's targets; for a draw also its set-up and where its triangles are.
struct Job {
  const Command* command = nullptr;
  Targets targets = {};
  DrawSetup setup = {};
  FragmentSetup fragments = {};
  std::size_t geometry = 0;
  VertexColors colors = {};
};

/// Vertices [first, last) of a draw's geometry, or its chunk `first`.
struct Task {
  DrawGeometry* geometry;
  std::size_t first, last;
};

/// Vertices [first, last) of a draw that is lit at vertices.
struct LightTask {
  LitVertices* vertices;
  std::size_t first, last;
};

}  // namespace

struct ExecuteMemory::Parts {
  /// For what jobs hold; keeps what they give back.
  std::pmr::unsynchronized_pool_resource pool;
  std::vector<Job> jobs;
  /// The first geometry_count of them are in use.
  std::vector<std::unique_ptr<DrawGeometry>> geometries;
  std::size_t geometry_count = 0;
  /// The first lit_count of them are in use.
  std::vector<std::unique_ptr<LitVertices>> lit;
  std::size_t lit_count = 0;
  std::vector<Task> vertices, chunks;
  std::vector<LightTask> lights;
};

ExecuteMemory::ExecuteMemory() : parts_(std::make_unique<Parts>()) {}
ExecuteMemory::~ExecuteMemory() = default;

namespace {

using Memory = ExecuteMemory::Parts;

/// Finds the geometry that serves a draw, or begins one.
std::size_t geometry_of(Memory& memory, const DrawSetup& setup) {
  for (std::size_t i = 0; i < memory.geometry_count; ++i)
    if (memory.geometries[i]->serves(setup)) return i;
  if (memory.geometry_count == memory.geometries.size())
    memory.geometries.push_back(std::make_unique<DrawGeometry>());
  memory.geometries[memory.geometry_count]->begin(setup);
  return memory.geometry_count++;
}

/// Colours of the draw's vertices, which the first phase lights if that is asked for.
VertexColors colors_of(Memory& memory, const Draw& draw, const FragmentSetup& fragments) {
  if (!fragments.color || !lights_vertices(draw)) return {draw.mesh.colors, draw.mesh.colors};
  if (memory.lit_count == memory.lit.size()) memory.lit.push_back(std::make_unique<LitVertices>());
  LitVertices& lit = *memory.lit[memory.lit_count++];
  lit.begin(draw);
  for (std::size_t i = 0; i < lit.vertex_count(); i += kVerticesPerPiece)
    memory.lights.push_back({&lit, i, std::min(lit.vertex_count(), i + kVerticesPerPiece)});
  return lit.colors();
}

void set_up_draws(Memory& memory, const Kernels& kernels) {
  memory.geometry_count = memory.lit_count = 0;
  memory.vertices.clear();
  memory.chunks.clear();
  memory.lights.clear();
  for (Job& job : memory.jobs) {
    const Draw* draw = std::get_if<Draw>(job.command);
    if (!draw) continue;
    job.setup = make_draw_setup(*draw, job.targets);
    job.fragments = make_fragment_setup(*draw, job.targets, kernels, memory.pool);
    job.geometry = geometry_of(memory, job.setup);
    job.colors = colors_of(memory, *draw, job.fragments);
  }
  for (std::size_t g = 0; g < memory.geometry_count; ++g) {
    DrawGeometry* const geometry = memory.geometries[g].get();
    for (std::size_t i = 0; i < geometry->vertex_count(); i += kVerticesPerPiece)
      memory.vertices.push_back(
          {geometry, i, std::min(geometry->vertex_count(), i + kVerticesPerPiece)});
    for (std::size_t chunk = 0; chunk < geometry->chunk_count(); ++chunk)
      memory.chunks.push_back({geometry, chunk, chunk + 1});
  }
}

/// The corners of a box round the triangles of one geometry in a tile, kept for the draws that
/// share it.
class TileBox {
 public:
  /// Absent if there is no such box, or a triangle is cut.
  const std::optional<std::array<glm::vec4, 8>>& corners(const Job& job,
                                                         const DrawGeometry& geometry,
                                                         TileIndex tile) {
    if (geometry_ != &geometry) corners_ = corners_of(job.setup.draw->mesh, geometry, tile);
    geometry_ = &geometry;
    return corners_;
  }

 private:
  static std::optional<std::array<glm::vec4, 8>> corners_of(const MeshView& mesh,
                                                            const DrawGeometry& geometry,
                                                            TileIndex tile) {
    PositionBox box;
    for (const TriangleChunk& chunk : geometry.chunks())
      for (const std::uint32_t number : chunk.bins.of(tile)) {
        const SetupTriangle& triangle = chunk.set_up.triangles[number];
        if (triangle.piece != SetupTriangle::kWhole) return std::nullopt;
        for (std::size_t k = 0; k < 3; ++k)
          box.add(mesh.positions[mesh.indices[triangle.first_index + k]]);
      }
    return box.corners();
  }

  const DrawGeometry* geometry_ = nullptr;
  std::optional<std::array<glm::vec4, 8>> corners_;
};

bool is_idle(DrawInTile& draw, const Job& job, const DrawGeometry& geometry, TileIndex tile,
             TileBox& box) {
  if (draw.is_idle()) return true;
  if (!draw.selects_by_lookup()) return false;
  const auto& corners = box.corners(job, geometry, tile);
  return corners && draw.is_idle_in(*corners);
}

void draw_in_tile(const Job& job, const DrawGeometry& geometry, TilePixels& pixels, TileBox& box) {
  std::optional<DrawInTile> draw;
  for (const TriangleChunk& chunk : geometry.chunks()) {
    const std::span<const std::uint32_t> numbers = chunk.bins.of(pixels.tile());
    if (numbers.empty()) continue;
    if (!draw &&
        is_idle(draw.emplace(job.setup, job.fragments, pixels), job, geometry, pixels.tile(), box))
      return;
    const TriangleSource source = geometry.source_of(chunk, job.colors);
    for (const std::uint32_t number : numbers) draw->draw(chunk.set_up.triangles[number], source);
  }
}

void run_tile(const Memory& memory, const Kernels& kernels, std::size_t tile, const Size& size) {
  TilePixels pixels(
      kernels, {static_cast<int>(tile) % size.tiles_x(), static_cast<int>(tile) / size.tiles_x()});
  TileBox box;
  for (const Job& job : memory.jobs) {
    pixels.use(job.targets);
    if (const Clear* clear = std::get_if<Clear>(job.command))
      clear_tile(*clear, pixels);
    else if (const Blit* blit = std::get_if<Blit>(job.command))
      blit_tile(*blit, pixels);
    else
      draw_in_tile(job, *memory.geometries[job.geometry], pixels, box);
  }
}

std::size_t triangles_of(const Command& command) {
  const Draw* draw = std::get_if<Draw>(&command);
  return draw ? draw->mesh.indices.size() / 3 : 0;
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

void run_group(Memory& memory, const Size& size, const Kernels& kernels, int threads) {
  if (memory.jobs.empty()) return;
  set_up_draws(memory, kernels);
  const auto run_vertices = [&](std::size_t i) {
    if (i < memory.vertices.size()) {
      const Task& task = memory.vertices[i];
      task.geometry->run_vertices(kernels, task.first, task.last);
      return;
    }
    const LightTask& task = memory.lights[i - memory.vertices.size()];
    task.vertices->run(kernels, task.first, task.last);
  };
  const auto run_chunk = [&](std::size_t i) {
    memory.chunks[i].geometry->run_chunk(kernels, memory.chunks[i].first);
  };
  const auto run_one_tile = [&](std::size_t tile) { run_tile(memory, kernels, tile, size); };
  // References, so that a std::function allocates nothing.
  const Phase phases[] = {
      {memory.vertices.size() + memory.lights.size(), std::ref(run_vertices)},
      {memory.chunks.size(), std::ref(run_chunk)},
      {static_cast<std::size_t>(size.tiles_x()) * size.tiles_y(), std::ref(run_one_tile)}};
  run_phases(phases, threads);
  memory.jobs.clear();
}

}  // namespace

void execute(const Frame& frame, const ExecuteOptions& options) {
  require(options.threads >= 0, "a number of threads is not negative");
  const Kernels& kernels = raster::kernels(options.isa);
  std::optional<ExecuteMemory> own;
  Memory& memory = *(options.memory ? *options.memory : own.emplace()).parts_;
  std::vector<Job>& jobs = memory.jobs;
  jobs.clear();
  Size size;
  std::size_t number = 0, triangles = 0;
  const auto finish_group = [&] {
    run_group(memory, size, kernels, options.threads);
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
