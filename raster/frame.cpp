#include "raster/frame.h"

#include <limits>

#include "raster/check.h"

namespace gnomon::raster {

namespace {

/// The first buffer's dimension that `of` reads.
template <class Of>
int dimension(const Targets& targets, Of of) {
  if (targets.color) return of(*targets.color);
  if (targets.depth) return of(*targets.depth);
  require(targets.stencil != nullptr, "a pass has a target");
  return of(*targets.stencil);
}

template <class Buffer>
void require_size(const Buffer* buffer, int width, int height) {
  require(!buffer || (buffer->width() == width && buffer->height() == height),
          "the targets of a pass have one size");
}

void require_texture(const std::shared_ptr<const Texture>& texture, const MeshView& mesh) {
  if (!texture) return;
  require(texture->width >= 1 && texture->height >= 1 && texture->width <= kMaxTargetSize &&
              texture->height <= kMaxTargetSize,
          "a texture is 1 to 16384 texels wide and high");
  require(texture->texels.size() == static_cast<std::size_t>(texture->width) * texture->height,
          "a texture has width x height texels");
  require(mesh.texcoords.size() == mesh.positions.size(),
          "a textured mesh has texture coordinates");
}

void require_lookup(const std::optional<DepthLookup>& lookup, const Targets& targets) {
  if (!lookup) return;
  require(lookup->map != nullptr, "a depth lookup has a map");
  require(lookup->map != targets.depth, "a draw does not look up the depth buffer it goes to");
}

void require_shading(const Draw& draw, const Targets& targets) {
  if (const Flat* flat = std::get_if<Flat>(&draw.shading)) {
    require_texture(flat->texture, draw.mesh);
    require_lookup(flat->depth_lookup, targets);
    return;
  }
  const Lit& lit = std::get<Lit>(draw.shading);
  require(draw.mesh.normals.size() == draw.mesh.positions.size(), "a lit mesh has normals");
  require(lit.material.shininess >= 0, "a specular exponent is not negative");
  for (const Light& light : lit.lights) {
    require(light.spot_exponent >= 0, "a spot exponent is not negative");
    require_lookup(light.shadow_map, targets);
    require(!lit.at_vertices || !light.shadow_map,
            "a draw that is lit at vertices has no shadow map, which only fragments can look up");
  }
  require_texture(lit.texture, draw.mesh);
}

void require_mesh(const MeshView& mesh) {
  const std::size_t count = mesh.positions.size();
  require(mesh.indices.size() % 3 == 0, "a mesh has three indices a triangle");
  require(mesh.indices.size() <= std::numeric_limits<std::uint32_t>::max(),
          "a mesh has fewer than 2^32 indices");
  require(mesh.normals.empty() || mesh.normals.size() == count, "normals are one a position");
  require(mesh.colors.empty() || mesh.colors.size() == count, "colours are one a position");
  require(mesh.texcoords.empty() || mesh.texcoords.size() == count,
          "texture coordinates are one a position");
  std::uint32_t largest = 0;
  for (const std::uint32_t index : mesh.indices) largest = index > largest ? index : largest;
  require(mesh.indices.empty() || largest < count, "an index lies below the number of positions");
}

void require_parts(const Draw& draw) {
  std::uint32_t least = 0;
  for (const MeshPart& part : draw.parts) {
    require(part.first_index % 3 == 0 && part.first_index >= least &&
                part.first_index <= draw.mesh.indices.size(),
            "the parts of a mesh begin at triangles of it, in order");
    least = part.first_index;
  }
}

void require_viewport(const std::optional<Rect>& viewport) {
  if (!viewport) return;
  const auto fits = [](int v) { return v >= -kMaxTargetSize && v <= kMaxTargetSize; };
  require(fits(viewport->x) && fits(viewport->y) && viewport->width >= 1 && viewport->height >= 1 &&
              fits(viewport->width) && fits(viewport->height),
          "a viewport is 1 to 16384 pixels wide and high and at most 16384 pixels away");
}

}  // namespace

int Targets::width() const {
  return dimension(*this, [](const auto& buffer) { return buffer.width(); });
}

int Targets::height() const {
  return dimension(*this, [](const auto& buffer) { return buffer.height(); });
}

void Frame::begin_pass(std::string_view label, const Targets& targets) {
  const int width = targets.width(), height = targets.height();
  require_size(targets.color, width, height);
  require_size(targets.depth, width, height);
  require_size(targets.stencil, width, height);
  passes_.push_back({std::string(label), targets, {}});
}

Pass& Frame::current() {
  require(!passes_.empty(), "begin_pass comes before commands");
  return passes_.back();
}

void Frame::clear(const Clear& clear) {
  Pass& pass = current();
  require(!clear.color || pass.targets.color, "a colour clear needs a colour target");
  require(!clear.depth || pass.targets.depth, "a depth clear needs a depth target");
  require(!clear.stencil || pass.targets.stencil, "a stencil clear needs a stencil target");
  pass.commands.emplace_back(clear);
}

void Frame::draw(Draw draw) {
  Pass& pass = current();
  require_mesh(draw.mesh);
  require_parts(draw);
  require_viewport(draw.state.viewport);
  const DepthRange& range = draw.state.depth_range;
  require(range.near >= 0.0f && range.near <= 1.0f && range.far >= 0.0f && range.far <= 1.0f,
          "a depth range lies in [0, 1]");
  require_shading(draw, pass.targets);
  pass.commands.emplace_back(std::move(draw));
}

void Frame::blit(const Blit& blit) {
  require(current().targets.color, "a blit needs a colour target");
  const ImageView& image = blit.image;
  require(image.data && image.width >= 1 && image.height >= 1 && image.width <= kMaxTargetSize &&
              image.height <= kMaxTargetSize,
          "an image is 1 to 16384 pixels wide and high");
  require(image.channels == 3 || image.channels == 4, "an image has 3 or 4 channels");
  current().commands.emplace_back(blit);
}

std::size_t Frame::command_count() const {
  std::size_t count = 0;
  for (const Pass& pass : passes_) count += pass.commands.size();
  return count;
}

}  // namespace gnomon::raster
