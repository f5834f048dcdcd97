#include "apps/study/photograph_sweeps.h"

#include "apps/study/pass_sweeps.h"
#include "apps/study/phantom_sweeps.h"
#include "apps/study/response_sweeps.h"
#include "apps/study/tag_sweeps.h"

namespace gnomon::apps::study {

namespace fs = std::filesystem;

bool has_photographs(const fs::path& examples) {
  return fs::is_regular_file(examples / "desk" / "background.png") &&
         fs::is_regular_file(examples / "soft" / "background.png");
}

void add_photograph_sweeps(Sweeps& sweeps, const fs::path& examples, int threads) {
  const auto room = std::make_shared<SoftRoom>(examples / "soft", threads);
  const auto desk = std::make_shared<Desk>(examples / "desk", threads);
  add_pass_sweeps(sweeps, room);
  add_response_sweeps(sweeps, room, desk);
  add_tag_sweeps(sweeps, desk);
  add_phantom_sweeps(sweeps, desk);
}

}  // namespace gnomon::apps::study
