#include "pipeline/haller.h"

#include <string>

#include "pipeline/full_screen.h"
#include "pipeline/light_pass.h"
#include "pipeline/light_samples.h"
#include "raster/check.h"

namespace gnomon::pipeline {
namespace {

using raster::CompareFunc;
using raster::StencilOp;

/// Seven bits count volumes where the eighth remembers that a pixel is in a real shadow.
constexpr std::uint8_t kSevenBits = 0x7f;

/// Stencil marks of visible virtual objects, by whether they receive shadows.
constexpr int kMarkVirtual = 1, kMarkReceiver = 2;

/// The volumes of one light, apart by the role of their caster.
struct LightVolumes {
  std::vector<PlacedVolume> real, virtual_;
};

class Recorder {
 public:
  Recorder(const Scene& scene, const Camera& camera, const raster::ImageView& photograph,
           const raster::Targets& targets, const HallerOptions& options)
      : scene_(scene),
        camera_(camera),
        photograph_(photograph),
        targets_(targets),
        options_(options),
        mask_targets_{options.masks, targets.depth, targets.stencil},
        lights_(sample_lights(scene)) {
    TopologyCache own_topologies;
    objects_ =
        place_objects(scene, camera, options.topologies ? *options.topologies : own_topologies);
    const VolumeOptions volume_options = make_volume_options();
    const Receivers receivers = receivers_for(volume_options, scene);
    const std::optional<NearRegion> region = near_region(camera.clip_from_world);
    for (const Light& light : lights_) {
      volumes_.push_back(volumes_of(light, receivers, region, volume_options));
    }
    if (lights_.size() > 1) texture_ = photograph_texture(photograph);
  }

  raster::Frame record() && {
    step_1();
    step_2();
    if (lights_.size() == 1) {
      step_3_one_light();
    } else {
      step_3_several_lights();
    }
    if (options_.masks) mask_shadows_on_virtual();
    return std::move(frame_);
  }

 private:
  VolumeOptions make_volume_options() const {
    return {.method = options_.method,
            .extrusion = options_.extrusion,
            .all_caps = options_.all_caps,
            // The second step counts their volumes on the phantoms alone.
            .counted_before_drawn = Role::virtual_object,
            .counts = options_.appendix_letter ? Counts::everywhere : options_.counts,
            .view = View{camera_.clip_from_world, targets_.width(), targets_.height(),
                         targets_.depth->format()},
            .threads = options_.threads,
            .memory = options_.volumes};
  }

  LightVolumes volumes_of(const Light& light, const Receivers& receivers,
                          const std::optional<NearRegion>& region, VolumeOptions options) const {
    const Casters casters(scene_, light);
    options.casters = &casters;
    LightVolumes result;
    for (PlacedVolume& volume : make_volumes(objects_, light, receivers, region, options)) {
      const bool real = volume.caster->role == Role::phantom;
      (real ? result.real : result.virtual_).push_back(std::move(volume));
    }
    return result;
  }

  void begin(const char* label, const Light* light = nullptr) {
    std::string name = label;
    if (light && lights_.size() > 1) name += ": " + light->name;
    frame_.begin_pass(name, targets_);
  }
  void begin_mask(const char* label, const Light* light = nullptr) {
    std::string name = label;
    if (light && lights_.size() > 1) name += ": " + light->name;
    frame_.begin_pass(name, mask_targets_);
  }

  void count(std::span<const PlacedVolume> volumes, const Light& light,
             std::uint8_t write_mask = 0xff) {
    count_volumes(frame_, volumes,
                  {.appendix_letter = options_.appendix_letter,
                   .write_mask = write_mask,
                   .in_batches = true,
                   .casters_drawn = virtual_objects_drawn_ && !options_.all_caps,
                   .light_name = light.name});
  }

  void step_1() {
    begin(haller_label::kReal);
    frame_.clear({.color = glm::vec4(0.0f), .depth = 1.0f, .stencil = 0});
    // Alpha stays 0: it will tell virtual objects from the photograph.
    frame_.blit({.image = photograph_, .color_write = {true, true, true, false}});
    if (!options_.masks) return;
    begin_mask(haller_label::kMaskClear);
    frame_.clear({.color = glm::vec4(0.0f)});
  }

  void step_2() {
    begin(haller_label::kPhantoms);
    raster::State state = surface_state();
    state.depth = raster::DepthState{};
    for (const PlacedObject& object : objects_) {
      if (object.is(Role::phantom)) draw_depth(frame_, object, state);
    }
    for (std::size_t i = 0; i < lights_.size(); ++i) {
      if (lights_[i].share <= 0.0f) continue;
      count_except(volumes_[i].virtual_,
                   options_.double_shadows ? std::vector<PlacedVolume>{} : volumes_[i].real,
                   lights_[i], haller_label::kRealVolumes, haller_label::kVirtualVolumes);
      spare_non_receivers();
      darken(lights_[i]);
    }
  }

  /// Leaves the stencil not 0 where the visible point lies in a counted volume and in none of
  /// `except`. Bit 7 remembers the latter, so the counts have seven bits.
  void count_except(const std::vector<PlacedVolume>& volumes,
                    const std::vector<PlacedVolume>& except, const Light& light,
                    const char* except_label, const char* label) {
    if (!except.empty()) {
      begin(except_label, &light);
      frame_.clear({.stencil = 0});
      count(except, light);
      flag_counts(frame_);
    }
    begin(label, &light);
    if (except.empty()) frame_.clear({.stencil = 0});
    count(volumes, light, except.empty() ? std::uint8_t{0xff} : kSevenBits);
    if (!except.empty()) drop_flagged(frame_);
  }

  /// Zeroes the stencil where a phantom that receives no shadow is visible.
  void spare_non_receivers() {
    raster::State state = surface_state();
    state.depth = raster::DepthState{.func = CompareFunc::equal, .write = false};
    state.stencil = raster::StencilState::both({.pass = StencilOp::zero});
    for (const PlacedObject& object : objects_) {
      if (object.is(Role::phantom) && !object.object->receives) draw_depth(frame_, object, state);
    }
  }

  static raster::StencilState where_counted() {
    return raster::StencilState::both({.func = CompareFunc::not_equal});
  }

  void darken(const Light& light) {
    begin(haller_label::kShadowOnReal, &light);
    raster::Draw draw;
    raster::Blend blend{.src_color = raster::BlendFactor::one,
                        .dst_color = raster::BlendFactor::one};
    if (lights_.size() == 1) {
      // The paper's black transparent polygon.
      draw = full_screen_quad(frame_, "shadow plane");
      draw.shading = raster::Flat{glm::vec4(0.0f, 0.0f, 0.0f, light.share)};
      blend.src_color = raster::BlendFactor::src_alpha;
      blend.dst_color = raster::BlendFactor::one_minus_src_alpha;
    } else {
      draw = photograph_quad(frame_, texture_, light.share, "shadow plane");
      blend.color_op = raster::BlendOp::reverse_subtract;
    }
    draw.state.depth = where_a_surface_is();
    draw.state.stencil = where_counted();
    draw.state.color = {.write = {true, true, true, false}, .blend = blend};
    frame_.draw(std::move(draw));
    if (options_.masks) {
      begin_mask(haller_label::kMaskShadowOnReal, &light);
      draw_mark(glm::vec4(1.0f), {true, false, false, false}, where_counted(), 0, "shadow plane",
                where_a_surface_is());
    }
  }

  void draw_mark(const glm::vec4& color, std::array<bool, 4> write,
                 const raster::StencilState& stencil, int ref, std::string label,
                 std::optional<raster::DepthState> depth = {},
                 std::optional<raster::Blend> blend = {}) {
    raster::Draw draw = full_screen_quad(frame_, std::move(label));
    draw.shading = raster::Flat{color};
    draw.state.depth = depth;
    draw.state.stencil = stencil;
    draw.state.color = {.write = write, .blend = blend};
    draw.stencil_ref = ref;
    frame_.draw(std::move(draw));
  }

  /// Draws the virtual objects in front of the phantoms, whose depth still stands from step 2, and
  /// leaves alpha 1 where one is visible: exactly there, whatever alpha a texture has.
  void draw_virtual_lit(const LightTerms& terms) {
    begin(haller_label::kVirtualLit);
    virtual_objects_drawn_ = true;
    frame_.clear({.stencil = 0});
    raster::State state = surface_state();
    state.depth = raster::DepthState{};
    state.color.write = {true, true, true, false};
    state.stencil = raster::StencilState::both({.pass = StencilOp::replace});
    for (const PlacedObject& object : objects_) {
      if (!object.is(Role::virtual_object)) continue;
      const int mark = object.object->receives ? kMarkReceiver : kMarkVirtual;
      draw_lit(frame_, object, scene_, camera_, terms, state, mark);
    }
    draw_mark(glm::vec4(1.0f), {false, false, false, true}, where_counted(), 0,
              "alpha of visible virtual objects");
    if (!options_.masks) return;
    begin_mask(haller_label::kMaskVirtual);
    // r goes back to 0: no real surface is visible here any more.
    draw_mark({0.0f, 0.0f, 1.0f, 0.0f}, {true, true, true, true}, where_counted(), 0,
              "visible virtual objects");
    draw_mark(glm::vec4(1.0f), {false, false, false, true},
              raster::StencilState::both({.func = CompareFunc::equal}), kMarkReceiver,
              "visible virtual objects that receive");
  }

  void count_all(std::size_t light) {
    begin(haller_label::kAllVolumes, &lights_[light]);
    frame_.clear({.stencil = 0});
    std::vector<PlacedVolume> all = volumes_[light].real;
    all.insert(all.end(), volumes_[light].virtual_.begin(), volumes_[light].virtual_.end());
    count(all, lights_[light]);
  }

  void step_3_one_light() {
    draw_virtual_lit(
        {.ambient = true, .emission = true, .diffuse = true, .specular = true, .lights = lights_});
    count_all(0);
    begin(haller_label::kShadowOnVirtual);
    raster::State state = surface_state();
    state.depth = raster::DepthState{.func = CompareFunc::equal, .write = false};
    state.stencil = where_counted();
    // Where a phantom in front has the very depth of a virtual object, alpha 0 keeps the
    // photograph.
    state.color = {.write = {true, true, true, false},
                   .blend = raster::Blend{.src_color = raster::BlendFactor::dst_alpha,
                                          .dst_color = raster::BlendFactor::one_minus_dst_alpha}};
    for (const PlacedObject& object : objects_) {
      if (!object.is(Role::virtual_object) || !object.object->receives) continue;
      draw_lit(frame_, object, scene_, camera_, {.ambient = true, .emission = true}, state);
    }
  }

  void step_3_several_lights() {
    draw_virtual_lit({.ambient = true, .emission = true});
    for (std::size_t i = 0; i < lights_.size(); ++i) {
      count_all(i);
      begin(haller_label::kShadowOnVirtual, &lights_[i]);
      for (const PlacedObject& object : objects_) {
        if (object.is(Role::virtual_object)) {
          add_light(frame_, object, scene_, camera_, lights_[i],
                    {.factor = raster::BlendFactor::dst_alpha});
        }
      }
    }
  }

  void mask_shadows_on_virtual() {
    // Alpha of the mask is 1 where a virtual receiver is visible: it lets the green through.
    const raster::Blend blend{.color_op = raster::BlendOp::add,
                              .src_color = raster::BlendFactor::dst_alpha,
                              .dst_color = raster::BlendFactor::one};
    for (std::size_t i = 0; i < lights_.size(); ++i) {
      // What a virtual object shades already, itself included, the real object takes no light from.
      count_except(volumes_[i].real, volumes_[i].virtual_, lights_[i],
                   haller_label::kMaskVirtualVolumes, haller_label::kMaskRealVolumes);
      begin_mask(haller_label::kMaskShadowOnVirtual, &lights_[i]);
      draw_mark(glm::vec4(1.0f), {false, true, false, false}, where_counted(), 0, "shadow plane",
                {}, blend);
    }
  }

  const Scene& scene_;
  const Camera& camera_;
  const raster::ImageView& photograph_;
  const raster::Targets targets_;
  const HallerOptions& options_;
  const raster::Targets mask_targets_;
  const std::vector<Light> lights_;
  std::vector<PlacedObject> objects_;
  std::vector<LightVolumes> volumes_;
  std::shared_ptr<const raster::Texture> texture_;
  raster::Frame frame_;
  bool virtual_objects_drawn_ = false;
};

}  // namespace

raster::Frame record_haller(const Scene& scene, const Camera& camera,
                            const raster::ImageView& photograph, const raster::Targets& targets,
                            const HallerOptions& options) {
  raster::require(targets.color && targets.depth && targets.stencil,
                  "the AR method needs colour, depth and stencil");
  raster::require(photograph.data != nullptr && photograph.width == targets.color->width() &&
                      photograph.height == targets.color->height(),
                  "the photograph has the targets' size");
  raster::require(!options.masks || options.masks->format() == raster::ColorFormat::rgba8,
                  "masks are RGBA8");
  return Recorder(scene, camera, photograph, targets, options).record();
}

}  // namespace gnomon::pipeline
