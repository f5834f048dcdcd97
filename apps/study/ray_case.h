// A light's shadow found in every way, against rays.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/study/chart_case.h"
#include "apps/study/shadow_trial.h"

namespace gnomon::apps::study {

class RayCase final : public ChartCase {
 public:
  /// `view` is called when contenders are asked for; its name is taken from here. Threads as in
  /// raster::ExecuteOptions. Preconditions of the view: those of ShadowTrial.
  RayCase(std::string name, std::function<View()> view, int threads);

  std::string name() const override { return name_; }
  std::vector<std::unique_ptr<Contender>> contenders() override;

 private:
  std::string name_;
  std::function<View()> view_;
  int threads_;
  std::optional<ShadowTrial> trial_;
};

}  // namespace gnomon::apps::study
