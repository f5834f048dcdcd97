// Soft shadows from a real room's own light in its photograph, against a photograph of the real
// thing and against rays with the same light.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "apps/study/captured_room.h"
#include "apps/study/chart_case.h"
#include "apps/study/study_file.h"

namespace gnomon::apps::study {

class RoomCase final : public ChartCase {
 public:
  /// Refers to `rooms`.
  RoomCase(StudyPhotograph photograph, CapturedRooms& rooms, int threads);
  ~RoomCase() override;

  std::string name() const override { return photograph_.name; }
  /// Errors: what place() and find_scene_light() throw.
  std::vector<std::unique_ptr<Contender>> contenders() override;

  struct Shared;

 private:
  StudyPhotograph photograph_;
  CapturedRooms& rooms_;
  int threads_;
  std::unique_ptr<Shared> shared_;
};

}  // namespace gnomon::apps::study
