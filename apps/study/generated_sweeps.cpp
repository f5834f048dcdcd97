#include "apps/study/generated_sweeps.h"

#include "apps/study/camera_sweeps.h"
#include "apps/study/count_sweeps.h"
#include "apps/study/depth_sweeps.h"
#include "apps/study/length_sweeps.h"
#include "apps/study/light_sweeps.h"
#include "apps/study/map_sweeps.h"
#include "apps/study/mesh_sweeps.h"

namespace gnomon::apps::study {

Sweeps generated_sweeps(int threads) {
  Sweeps sweeps;
  for (void (*add)(Sweeps&, int) :
       {add_camera_sweeps, add_light_sweeps, add_mesh_sweeps, add_count_sweeps, add_depth_sweeps,
        add_length_sweeps, add_map_sweeps})
    add(sweeps, threads);
  return sweeps;
}

}  // namespace gnomon::apps::study
