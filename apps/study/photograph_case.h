// Haller's method on a photograph, with phantoms and casters of every level of detail, against a
// photograph of the real thing and against rays.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/study/chart_case.h"
#include "apps/study/placed_photograph.h"
#include "apps/study/study_file.h"

namespace gnomon::apps::study {

class PhotographCase final : public ChartCase {
 public:
  /// Threads as in raster::ExecuteOptions.
  PhotographCase(StudyPhotograph photograph, int threads);
  ~PhotographCase() override;

  std::string name() const override { return photograph_.name + ", photograph"; }
  /// Errors: what place() throws; ar::InputError when the scene has no single light or the study
  /// names no shadow mask.
  std::vector<std::unique_ptr<Contender>> contenders() override;

  struct Shared;

 private:
  StudyPhotograph photograph_;
  int threads_;
  std::unique_ptr<Shared> shared_;
};

}  // namespace gnomon::apps::study
