// A light's shadow found in every way, against rays.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/study/chart_case.h"
#include "apps/study/shadow_trial.h"

namespace gnomon::apps::study {

class RayCase final : public ChartCase {
 public:
  /// Threads as in raster::ExecuteOptions. Preconditions: those of ShadowTrial.
  RayCase(View view, int threads);

  std::string name() const override { return view_.name; }
  std::vector<std::unique_ptr<Contender>> contenders() override;

 private:
  View view_;
  int threads_;
  std::optional<ShadowTrial> trial_;
};

}  // namespace gnomon::apps::study
