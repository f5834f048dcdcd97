// Mesa as a runner, llvmpipe or softpipe: the same triangles and passes in OpenGL 2.1, from vertex
// buffers that are filled once. Lighting is fixed-function, a vertex at a time.
#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>

#include <cmath>
#include <memory>
#include <span>
#include <stdexcept>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "ar/stopwatch.h"
#include "bench/layer.h"
#include "bench/runner.h"
#include "bench/volumes.h"
#include "peer/osmesa/osmesa_context.h"

namespace gnomon::bench {
namespace {

/// Triangles in buffers of their own, with what their draw needs.
struct GlMesh {
  GLuint vertices = 0, normals = 0, indices = 0;
  GLsizei count = 0;
  glm::mat4 world_from_model{1.0f};
  raster::FrontFace front_face = raster::FrontFace::ccw;
  bool cull_back = false;
  raster::Material material;
};

template <class Values>
GLuint upload(GLenum target, const Values& values) {
  GLuint buffer = 0;
  glGenBuffers(1, &buffer);
  glBindBuffer(target, buffer);
  const std::span bytes = std::as_bytes(std::span(values));
  glBufferData(target, static_cast<GLsizeiptr>(bytes.size()), bytes.data(), GL_STATIC_DRAW);
  return buffer;
}

GlMesh upload(const raster::MeshView& mesh, const glm::mat4& world_from_model,
              raster::FrontFace front_face) {
  GlMesh out{.count = static_cast<GLsizei>(mesh.indices.size()),
             .world_from_model = world_from_model,
             .front_face = front_face};
  out.vertices = upload(GL_ARRAY_BUFFER, mesh.positions);
  if (!mesh.normals.empty()) out.normals = upload(GL_ARRAY_BUFFER, mesh.normals);
  out.indices = upload(GL_ELEMENT_ARRAY_BUFFER, mesh.indices);
  return out;
}

void set_material(const raster::Material& material) {
  const glm::vec4 ambient(material.ambient, 1.0f), diffuse(material.diffuse, 1.0f);
  glMaterialfv(GL_FRONT_AND_BACK, GL_AMBIENT, glm::value_ptr(ambient));
  glMaterialfv(GL_FRONT_AND_BACK, GL_DIFFUSE, glm::value_ptr(diffuse));
}

enum class Attributes { position, lit };

void draw(const GlMesh& mesh, Attributes attributes) {
  glLoadMatrixf(glm::value_ptr(mesh.world_from_model));
  glFrontFace(mesh.front_face == raster::FrontFace::ccw ? GL_CCW : GL_CW);
  if (mesh.cull_back) glEnable(GL_CULL_FACE);
  glBindBuffer(GL_ARRAY_BUFFER, mesh.vertices);
  glVertexPointer(4, GL_FLOAT, 0, nullptr);
  if (attributes == Attributes::lit) {
    set_material(mesh.material);
    glEnableClientState(GL_NORMAL_ARRAY);
    glBindBuffer(GL_ARRAY_BUFFER, mesh.normals);
    glNormalPointer(GL_FLOAT, 0, nullptr);
  }
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh.indices);
  glDrawElements(GL_TRIANGLES, mesh.count, GL_UNSIGNED_INT, nullptr);
  glDisableClientState(GL_NORMAL_ARRAY);
  if (mesh.cull_back) glDisable(GL_CULL_FACE);
}

/// Normals keep their length under a rotation, and Mesa need not make it good a vertex.
bool scales(const glm::mat4& world_from_model) {
  constexpr float kRounding = 1e-4f;
  for (int column = 0; column < 3; ++column) {
    const float length = glm::length(glm::vec3(world_from_model[column]));
    if (std::abs(length - 1.0f) > kRounding) return true;
  }
  return false;
}

void set_color_write(bool on) {
  const GLboolean value = on ? GL_TRUE : GL_FALSE;
  glColorMask(value, value, value, value);
}

class GlRunner final : public Runner {
 public:
  GlRunner(const Subject& subject, const Task& task)
      : subject_(subject), method_(task.method), context_(subject.size.width, subject.size.height) {
    if (!context_.renderer().starts_with(name(task.system))) {
      throw std::runtime_error("Mesa draws with '" + context_.renderer() + "' where " +
                               std::string(name(task.system)) + " was asked for");
    }
    glViewport(0, 0, subject.size.width, subject.size.height);
    glEnable(GL_DEPTH_TEST);
    glEnableClientState(GL_VERTEX_ARRAY);
    if (subject_.kind == Kind::layer) {
      upload_layer();
    } else {
      upload_scene();
    }
    if (glGetError() != GL_NO_ERROR) throw std::runtime_error("OpenGL refuses the scene");
  }

  StageTimes frame() override {
    StageTimes times;
    glFinish();
    ar::Stopwatch timer;
    for (const Stage stage : stages()) run(stage);
    glFinish();
    at(times, Stage::frame) = timer.lap_ms();
    for (const Stage stage : stages()) {
      timer.lap_ms();
      run(stage);
      glFinish();
      at(times, stage) = timer.lap_ms();
    }
    if (subject_.kind == Kind::layer) at(times, Stage::scene).reset();
    return times;
  }

  Picture picture() override {
    const auto [width, height] = subject_.size;
    Picture out(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, out.data());
    if (subject_.kind == Kind::layer) return out;
    std::vector<std::uint32_t> depth(out.size());
    glReadPixels(0, 0, width, height, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8, depth.data());
    if (subject_.kind == Kind::depth) {
      for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] = static_cast<std::uint8_t>(depth[i] >> 24);
      }
      return out;
    }
    for (std::size_t i = 0; i < out.size(); ++i) {
      const bool seen = depth[i] >> 8 != 0xffffff;
      out[i] = static_cast<std::uint8_t>(seen ? (out[i] != 0 ? 2 : 1) : 0);
    }
    return out;
  }

 private:
  std::span<const Stage> stages() const {
    static constexpr std::array kAll{Stage::scene, Stage::volumes, Stage::shadow};
    const std::size_t count =
        subject_.kind == Kind::shadows ? 3 : (subject_.kind == Kind::layer ? 2 : 1);
    return std::span(kAll).first(count);
  }

  void upload_scene() {
    glMatrixMode(GL_PROJECTION);
    // Eye space is world space: lights and normals need no view of their own.
    glLoadMatrixf(glm::value_ptr(subject_.camera.clip_from_world));
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
    set_light();
    pipeline::TopologyCache topologies;
    const auto objects = pipeline::place_objects(subject_.scene, subject_.camera, topologies);
    for (const auto& object : objects) {
      if (scales(object.object->world_from_model)) glEnable(GL_NORMALIZE);
      for (std::size_t i = 0; i < object.meshes.size(); ++i) {
        surfaces_.push_back(
            upload(object.meshes[i]->view(), object.object->world_from_model, object.front_face));
        surfaces_.back().material = object.object->model->parts[i].material;
        surfaces_.back().cull_back = shows_one_side(object);
      }
    }
    if (subject_.kind != Kind::shadows) return;
    for (const auto& volume : make_volumes(subject_, objects, method_, 1, nullptr)) {
      volumes_.push_back(
          upload(volume.volume->view(), volume.caster->world_from_model, volume.front_face));
    }
  }

  void set_light() const {
    const pipeline::Light& light = subject_.scene.lights.at(0);
    const glm::vec4 ambient(subject_.scene.ambient, 1.0f), diffuse(light.color, 1.0f);
    const glm::vec4 none(0.0f);
    glLightModelfv(GL_LIGHT_MODEL_AMBIENT, glm::value_ptr(ambient));
    glLightfv(GL_LIGHT0, GL_POSITION, glm::value_ptr(light.position));
    glLightfv(GL_LIGHT0, GL_DIFFUSE, glm::value_ptr(diffuse));
    glLightfv(GL_LIGHT0, GL_SPECULAR, glm::value_ptr(none));
    glEnable(GL_LIGHT0);
  }

  void upload_layer() {
    surfaces_.push_back(upload(leaning_plane().view(), glm::mat4(1.0f), raster::FrontFace::ccw));
    volumes_.push_back(upload(layer().view(), glm::mat4(1.0f), raster::FrontFace::ccw));
    if (!subject_.random_depth) return;
    std::vector<std::uint32_t> depths = random_depths(subject_.size.width, subject_.size.height);
    for (std::uint32_t& depth : depths) depth <<= 8;
    glDepthFunc(GL_ALWAYS);
    glWindowPos2i(0, 0);
    glDrawPixels(subject_.size.width, subject_.size.height, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8,
                 depths.data());
  }

  void run(Stage stage) const {
    if (stage == Stage::scene) run_scene();
    if (stage == Stage::volumes) run_volumes();
    if (stage == Stage::shadow) run_shadow();
  }

  void run_scene() const {
    glDisable(GL_STENCIL_TEST);
    glDepthMask(GL_TRUE);
    if (subject_.kind == Kind::layer) {
      set_color_write(false);
      glClear(GL_STENCIL_BUFFER_BIT);
      glDepthFunc(GL_ALWAYS);
      if (!subject_.random_depth) draw(surfaces_[0], Attributes::position);
      return;
    }
    glDepthFunc(GL_LESS);
    if (subject_.kind == Kind::depth) {
      set_color_write(false);
      glClear(GL_DEPTH_BUFFER_BIT);
      for (const GlMesh& mesh : surfaces_) draw(mesh, Attributes::position);
      return;
    }
    set_color_write(true);
    glClearColor(0.0f, 0.0f, 0.0f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
    glEnable(GL_LIGHTING);
    for (const GlMesh& mesh : surfaces_) draw(mesh, Attributes::lit);
    glDisable(GL_LIGHTING);
  }

  void run_volumes() const {
    set_color_write(false);
    glDepthMask(GL_FALSE);
    glDepthFunc(GL_LESS);
    glEnable(GL_STENCIL_TEST);
    glStencilFunc(GL_ALWAYS, 0, 0xff);
    if (method_ == Method::zpass) {
      glStencilOpSeparate(GL_FRONT, GL_KEEP, GL_KEEP, GL_INCR_WRAP);
      glStencilOpSeparate(GL_BACK, GL_KEEP, GL_KEEP, GL_DECR_WRAP);
    } else if (subject_.kind == Kind::layer) {
      glStencilOp(GL_KEEP, GL_INCR_WRAP, GL_KEEP);
    } else {
      glStencilOpSeparate(GL_FRONT, GL_KEEP, GL_DECR_WRAP, GL_KEEP);
      glStencilOpSeparate(GL_BACK, GL_KEEP, GL_INCR_WRAP, GL_KEEP);
    }
    for (const GlMesh& mesh : volumes_) draw(mesh, Attributes::position);
  }

  void run_shadow() const {
    set_color_write(true);
    glDepthFunc(GL_EQUAL);
    glStencilFunc(GL_NOTEQUAL, 0, 0xff);
    glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
    glColor3f(0.1f, 0.1f, 0.1f);
    for (const GlMesh& mesh : surfaces_) draw(mesh, Attributes::position);
  }

  Subject subject_;
  Method method_;
  peer::OsmesaContext context_;
  /// Drawn in order; a layer's are what lies in front of it.
  std::vector<GlMesh> surfaces_, volumes_;
};

}  // namespace

std::unique_ptr<Runner> make_gl_runner(const Subject& subject, const Task& task) {
  return std::make_unique<GlRunner>(subject, task);
}

}  // namespace gnomon::bench
