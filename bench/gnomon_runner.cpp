// gnomon as a runner: a frame is recorded anew each time, as a moving scene would have it, and
// executed as a whole and pass by pass.
#include <cstddef>
#include <stdexcept>
#include <utility>

#include "ar/stopwatch.h"
#include "bench/layer.h"
#include "bench/runner.h"
#include "bench/volumes.h"
#include "golden/hash.h"
#include "pipeline/placed_object.h"
#include "raster/execute.h"

namespace gnomon::bench {
namespace {

constexpr glm::vec4 kShadowColor{0.1f, 0.1f, 0.1f, 1.0f};

struct Buffers {
  raster::ColorBuffer color;
  raster::DepthBuffer depth;
  raster::StencilBuffer stencil;

  explicit Buffers(Size size)
      : color(size.width, size.height),
        depth(size.width, size.height),
        stencil(size.width, size.height) {}
};

raster::Cull cull(const pipeline::PlacedObject& object) {
  return shows_one_side(object) ? raster::Cull::back : raster::Cull::none;
}

struct Recorded {
  raster::Frame frame;
  double volumes_ms = 0.0;
};

class GnomonRunner final : public Runner {
 public:
  GnomonRunner(const Subject& subject, Method method, int threads)
      : subject_(subject), method_(method), threads_(threads), buffers_(subject.size) {
    // As Mesa's fixed function does, so that both do the same work.
    subject_.scene.vertex_lighting = true;
    pipeline::place_objects(subject_.scene, subject_.camera, topologies_);
    if (subject_.random_depth) load_random_depth(buffers_.depth);
  }

  StageTimes frame() override {
    StageTimes times;
    ar::Stopwatch timer;
    const Recorded whole = record(buffers_);
    run(whole.frame, 0, whole.frame.command_count());
    at(times, Stage::frame) = timer.lap_ms();

    const Recorded recorded = record(buffers_);
    std::size_t first = 0, pass = 0;
    for (const Stage stage : {Stage::scene, Stage::volumes, Stage::shadow}) {
      if (pass == recorded.frame.passes().size()) break;
      const std::size_t end = first + recorded.frame.passes()[pass++].commands.size();
      timer.lap_ms();
      run(recorded.frame, first, end);
      at(times, stage) = timer.lap_ms();
      first = end;
    }
    if (times[1]) *times[1] += recorded.volumes_ms;
    if (subject_.kind == Kind::layer) at(times, Stage::scene).reset();
    return times;
  }

  Picture picture() override {
    Picture out = buffers_.stencil.to_rows();
    if (subject_.kind == Kind::layer) return out;
    const std::vector<std::uint32_t> depth = buffers_.depth.to_rows();
    if (subject_.kind == Kind::depth) {
      for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] = static_cast<std::uint8_t>(depth[i] >> 16);
      }
      return out;
    }
    for (std::size_t i = 0; i < out.size(); ++i) {
      const bool seen = depth[i] != buffers_.depth.max_value();
      out[i] = static_cast<std::uint8_t>(seen ? (out[i] != 0 ? 2 : 1) : 0);
    }
    return out;
  }

  std::vector<std::string> hashes() override {
    Buffers slow(subject_.size);
    if (subject_.random_depth) load_random_depth(slow.depth);
    const Recorded recorded = record(slow);
    raster::execute(recorded.frame, {.threads = 1, .isa = raster::Isa::scalar});
    frame();
    const auto timed = hashes_of(buffers_), expected = hashes_of(slow);
    for (std::size_t i = 0; i < timed.size(); ++i) {
      if (timed[i] == expected[i]) continue;
      throw std::runtime_error("gnomon's bytes differ between instruction sets: " + timed[i] +
                               " is timed, " + expected[i] + " is right");
    }
    return timed;
  }

 private:
  /// Of what the subject draws, what a person sees first.
  std::vector<std::string> hashes_of(const Buffers& buffers) const {
    const std::string depth = sentence(golden::hash_of(raster::Buffer(buffers.depth)));
    if (subject_.kind == Kind::depth) return {depth};
    const std::string stencil = sentence(golden::hash_of(raster::Buffer(buffers.stencil)));
    if (subject_.kind == Kind::layer) return {stencil, depth};
    return {sentence(golden::hash_of(raster::Buffer(buffers.color))), depth, stencil};
  }

  void load_random_depth(raster::DepthBuffer& depth) const {
    const auto [width, height] = subject_.size;
    const std::vector<std::uint32_t> values = random_depths(width, height);
    auto value = values.begin();
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) depth.plane().at(x, y) = *value++;
    }
  }

  void run(const raster::Frame& frame, std::size_t first, std::size_t end) {
    raster::execute(
        frame,
        {.threads = threads_, .memory = &execute_memory_, .first_command = first, .commands = end});
  }

  Recorded record(Buffers& buffers) {
    switch (subject_.kind) {
      case Kind::shadows:
        return record_shadows(buffers);
      case Kind::depth:
        return record_depth(buffers);
      case Kind::layer:
        break;
    }
    return record_layer(buffers);
  }

  Recorded record_shadows(Buffers& buffers) {
    Recorded out;
    const auto objects = pipeline::place_objects(subject_.scene, subject_.camera, topologies_);
    const raster::Targets targets{&buffers.color, &buffers.depth, &buffers.stencil};
    out.frame.begin_pass("scene", targets);
    out.frame.clear({.color = glm::vec4(0.0f, 0.0f, 0.0f, 1.0f), .depth = 1.0f, .stencil = 0});
    raster::State surface = pipeline::surface_state();
    surface.depth = raster::DepthState{};
    for (const auto& object : objects) {
      surface.cull = cull(object);
      pipeline::draw_lit(out.frame, object, subject_.scene, subject_.camera,
                         {.ambient = true, .diffuse = true, .lights = subject_.scene.lights},
                         surface);
    }
    out.frame.begin_pass("volumes", targets);
    ar::Stopwatch timer;
    record_volumes(out.frame, subject_, objects, method_, threads_, volume_memory_);
    out.volumes_ms = timer.lap_ms();
    out.frame.begin_pass("shadow", targets);
    raster::State shadow = pipeline::surface_state();
    shadow.depth = raster::DepthState{.func = raster::CompareFunc::equal, .write = false};
    shadow.stencil = raster::StencilState::both({.func = raster::CompareFunc::not_equal});
    for (const auto& object : objects) draw_flat(out.frame, object, shadow);
    return out;
  }

  static void draw_flat(raster::Frame& frame, const pipeline::PlacedObject& object,
                        raster::State state) {
    state.front_face = object.front_face;
    state.cull = cull(object);
    for (const auto& mesh : object.meshes) {
      frame.keep(mesh);
      frame.draw({.state = state,
                  .mesh = {mesh->positions, mesh->indices},
                  .clip_from_model = object.clip_from_model,
                  .shading = raster::Flat{.color = kShadowColor}});
    }
  }

  Recorded record_depth(Buffers& buffers) {
    Recorded out;
    out.frame.begin_pass("scene", {.depth = &buffers.depth});
    out.frame.clear({.depth = 1.0f});
    raster::State state = pipeline::surface_state();
    state.depth = raster::DepthState{};
    for (const auto& object :
         pipeline::place_objects(subject_.scene, subject_.camera, topologies_)) {
      state.cull = cull(object);
      pipeline::draw_depth(out.frame, object, state);
    }
    return out;
  }

  Recorded record_layer(Buffers& buffers) const {
    Recorded out;
    const raster::Targets targets{nullptr, &buffers.depth, &buffers.stencil};
    out.frame.begin_pass("scene", targets);
    out.frame.clear({.stencil = 0});
    if (!subject_.random_depth) {
      raster::State plane = pipeline::surface_state();
      plane.depth = raster::DepthState{.func = raster::CompareFunc::always};
      out.frame.draw({.state = plane, .mesh = plane_.view()});
    }
    out.frame.begin_pass("volumes", targets);
    raster::State state = pipeline::surface_state();
    state.depth = raster::DepthState{.func = raster::CompareFunc::less, .write = false};
    state.stencil = raster::StencilState::both({.depth_fail = raster::StencilOp::incr_wrap});
    out.frame.draw({.state = state, .mesh = layer_.view()});
    return out;
  }

  Subject subject_;
  Method method_;
  int threads_;
  Buffers buffers_;
  pipeline::TopologyCache topologies_;
  raster::ExecuteMemory execute_memory_;
  pipeline::VolumeMemory volume_memory_;
  pipeline::Mesh plane_ = leaning_plane(), layer_ = layer();
};

}  // namespace

std::unique_ptr<Runner> make_gnomon_runner(const Subject& subject, Method method, int threads) {
  return std::make_unique<GnomonRunner>(subject, method, threads);
}

}  // namespace gnomon::bench
