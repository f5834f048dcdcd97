// The view that is the scene's own: `gnomon render`.
#include <utility>

#include "ar/fit_drawing.h"
#include "ar/image_file.h"
#include "ar/render_scene.h"

namespace gnomon::ar {

namespace {

class ByItself : public FitDrawing {
 public:
  ByItself(const SceneFile& file, int threads) : threads_(threads) {
    // Bodies have no place without tags.
    for (const SceneObject& object : file.objects) placed_.insert(object.name);
    for (const std::string& name : render_scene(file, {.threads = threads}).left_out)
      placed_.erase(name);
  }

  FitPictures draw(const FitScene& scene) override {
    FitPictures out;
    Rendered rendered = render(scene);
    out.ms = rendered.record_ms + rendered.execute_ms;
    out.pictures.push_back(to_rgb(rendered.picture));
    return out;
  }

  std::vector<Image> untouched(const FitScene& scene) override {
    FitScene lit = scene;
    for (FitObject& object : lit.objects) object.casts = false;
    return {to_rgb(render(lit).picture)};
  }

  Image show(const FitScene& scene) override { return to_rgb(render(scene).picture); }

  const std::set<std::string>& placed() const override { return placed_; }

 private:
  Rendered render(const FitScene& scene) {
    SceneFile file = scene.file;
    std::vector<ObjectModels> models;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
      file.objects[i].casts = scene.objects[i].casts;
      models.push_back(scene.objects[i].models);
      if (!scene.objects[i].casts) models.back().shadow_model = nullptr;
    }
    return render_scene(file, models, {.threads = threads_}, memory_);
  }

  int threads_;
  std::set<std::string> placed_;
  RenderMemory memory_;
};

}  // namespace

std::unique_ptr<FitDrawing> draw_by_itself(const SceneFile& file, int threads) {
  return std::make_unique<ByItself>(file, threads);
}

}  // namespace gnomon::ar
