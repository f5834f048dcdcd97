#include "bench/runner.h"

#include <stdexcept>

namespace gnomon::bench {
namespace {

constexpr std::array<std::string_view, kSystems.size()> kSystemNames{"gnomon", "llvmpipe",
                                                                     "softpipe", "embree"};
constexpr std::array<std::string_view, kMethods.size()> kMethodNames{"zpass", "zfail", "auto",
                                                                     "rays"};
constexpr std::array<std::string_view, kStages.size()> kStageNames{"scene", "volumes", "shadow",
                                                                   "frame"};

template <class Values>
auto named(const Values& values, std::string_view wanted, const char* what) {
  for (const auto value : values) {
    if (name(value) == wanted) return value;
  }
  throw std::invalid_argument("there is no " + std::string(what) + " '" + std::string(wanted) +
                              "'");
}

}  // namespace

std::string_view name(System system) { return kSystemNames[static_cast<std::size_t>(system)]; }
std::string_view name(Method method) { return kMethodNames[static_cast<std::size_t>(method)]; }
std::string_view name(Stage stage) { return kStageNames[static_cast<std::size_t>(stage)]; }

System system_named(std::string_view wanted) { return named(kSystems, wanted, "system"); }
Method method_named(std::string_view wanted) { return named(kMethods, wanted, "method"); }

std::unique_ptr<Runner> make_runner(const Subject& subject, const Task& task) {
  switch (task.system) {
    case System::gnomon:
      return make_gnomon_runner(subject, task.method, task.threads);
    case System::llvmpipe:
    case System::softpipe:
      return make_gl_runner(subject, task);
    case System::embree:
      break;
  }
  return make_embree_runner(subject, task.threads);
}

}  // namespace gnomon::bench
