// One system that draws one subject by one method, and says how long each stage took.
// Invariant: what does not change between frames (meshes, their edges, buffers, vertex buffers) is
// made in the constructor; what a moving scene would need every frame is timed.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/subject.h"

namespace gnomon::bench {

enum class System : std::uint8_t { gnomon, llvmpipe, softpipe, embree };
enum class Method : std::uint8_t { zpass, zfail, automatic, rays };
/// docs/performance.md says what each means for each system.
enum class Stage : std::uint8_t { scene, volumes, shadow, frame };

inline constexpr std::array kSystems{System::gnomon, System::llvmpipe, System::softpipe,
                                     System::embree};
inline constexpr std::array kMethods{Method::zpass, Method::zfail, Method::automatic, Method::rays};
inline constexpr std::array kStages{Stage::scene, Stage::volumes, Stage::shadow, Stage::frame};

std::string_view name(System system);
/// "zpass", "zfail", "auto" or "rays".
std::string_view name(Method method);
std::string_view name(Stage stage);
/// Throw std::invalid_argument for another name.
System system_named(std::string_view name);
Method method_named(std::string_view name);

/// Milliseconds by Stage; absent where the subject has no such stage.
using StageTimes = std::array<std::optional<double>, kStages.size()>;

inline std::optional<double>& at(StageTimes& times, Stage stage) {
  return times[static_cast<std::size_t>(stage)];
}

/// A byte a pixel, rows from the bottom one. Of a scene with shadows: 0 nothing is seen, 1 what is
/// seen is lit, 2 it is in shadow. Of depth only: its upper 8 bits. Of a layer: the stencil.
using Picture = std::vector<std::uint8_t>;

class Runner {
 public:
  virtual ~Runner() = default;

  /// Draws the frame twice: as a whole, which is Stage::frame, and stage by stage.
  virtual StageTimes frame() = 0;
  /// What the last frame() left.
  virtual Picture picture() = 0;
  /// gnomon: a hash of every buffer's bytes, the same for scalar code on one thread as for what is
  /// timed; throws std::runtime_error where they differ. Others: empty.
  virtual std::vector<std::string> hashes() { return {}; }
};

/// What a system is asked to do.
struct Task {
  System system = System::gnomon;
  Method method = Method::automatic;
  int threads = 1;
};

/// Mesa's driver and its threads are taken from the environment (worker.cpp sets it).
/// Throws std::runtime_error when the system cannot start.
std::unique_ptr<Runner> make_runner(const Subject& subject, const Task& task);

std::unique_ptr<Runner> make_gnomon_runner(const Subject& subject, Method method, int threads);
std::unique_ptr<Runner> make_gl_runner(const Subject& subject, const Task& task);
std::unique_ptr<Runner> make_embree_runner(const Subject& subject, int threads);

}  // namespace gnomon::bench
