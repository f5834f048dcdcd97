// The error of intensity transfers against the number of hidden patches (Gibson 2003, figure 3), as
// rows for gnuplot (intensity.gp) and a table.
// Usage: measure_intensity LIT_SCENE [ROWS]
//
// Four data sets: 50 sources, chosen at random, at each of four vertices of the scene that get much
// light and lie far apart; the transfers are scaled so that together they are 70 % of the vertex's
// light, as the source set's are of all power. For each set size and each number of hidden patches,
// 10,000 choices of the hidden ones.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <numeric>
#include <random>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "ar/lit_scene_file.h"
#include "pipeline/intensity_transfer.h"
#include "pipeline/source_set.h"

namespace gnomon::ar {
namespace {

constexpr std::size_t kSources = 50;
constexpr int kTrials = 10'000;
/// Of a vertex's light.
constexpr double kShare = 0.7;

struct DataSet {
  glm::dvec3 light{0.0};
  /// By falling luminance.
  std::vector<glm::vec3> transfers;
};

/// Vertices by what they get, each at least a metre from those before it.
std::vector<std::uint32_t> bright_vertices(const pipeline::LitScene& scene,
                                           const pipeline::Transfers& transfers,
                                           std::size_t count) {
  std::vector<double> sum(transfers.vertices, 0.0);
  for (std::size_t s = 0; s < transfers.sources.size(); ++s) {
    for (std::size_t v = 0; v < sum.size(); ++v) sum[v] += pipeline::luminance(transfers.row(s)[v]);
  }
  std::vector<std::uint32_t> order(sum.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return sum[a] > sum[b]; });
  std::vector<std::uint32_t> chosen;
  for (const std::uint32_t v : order) {
    const auto far = [&](std::uint32_t other) {
      return glm::distance(scene.model.vertices[v].position, scene.model.vertices[other].position) >
             1.0f;
    };
    if (chosen.size() < count && std::all_of(chosen.begin(), chosen.end(), far))
      chosen.push_back(v);
  }
  return chosen;
}

std::vector<DataSet> data_sets(const pipeline::LitScene& scene) {
  const pipeline::Transfers transfers =
      pipeline::compute_transfers(scene, {.power_share = 1.0, .samples = 1});
  std::mt19937 random(2003);
  std::vector<DataSet> sets;
  const std::vector<glm::vec3> light = pipeline::at_vertices(scene.model, scene.radiance);
  for (const std::uint32_t v : bright_vertices(scene, transfers, 4)) {
    std::vector<glm::vec3> given;
    for (std::size_t s = 0; s < transfers.sources.size(); ++s) {
      if (transfers.row(s)[v] != glm::vec3(0.0f)) given.push_back(transfers.row(s)[v]);
    }
    for (std::size_t i = 0; i + 1 < given.size(); ++i)
      std::swap(given[i], given[i + random() % (given.size() - i)]);
    given.resize(std::min(given.size(), kSources));
    glm::dvec3 sum(0.0);
    for (const glm::vec3& transfer : given) sum += glm::dvec3(transfer);
    DataSet set{glm::dvec3(light[v]), {}};
    for (const glm::vec3& transfer : given)
      set.transfers.push_back(glm::vec3(glm::dvec3(transfer) * set.light * (kShare / sum)));
    std::stable_sort(set.transfers.begin(), set.transfers.end(),
                     [](const glm::vec3& a, const glm::vec3& b) {
                       return pipeline::luminance(a) > pipeline::luminance(b);
                     });
    sets.push_back(std::move(set));
  }
  return sets;
}

/// Variance over trials and data sets of what is left over in equation 3, a channel at a time.
glm::dvec3 variance(const pipeline::ToneCurve& tone, const std::vector<DataSet>& sets,
                    double first_share, std::size_t hidden, std::mt19937& random) {
  glm::dvec3 sum(0.0), squares(0.0);
  double count = 0.0;
  for (const DataSet& set : sets) {
    const std::size_t n = set.transfers.size();
    std::vector<std::uint8_t> first(n);
    // Exactly that share, chosen at random once a data set.
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::mt19937 fixed(7);
    for (std::size_t i = 0; i + 1 < n; ++i) std::swap(order[i], order[i + fixed() % (n - i)]);
    for (std::size_t i = 0; i < n; ++i)
      first[order[i]] = static_cast<double>(i) < first_share * static_cast<double>(n) ? 1 : 0;
    std::vector<glm::vec3> values(n);
    pipeline::intensity_transfers(tone, set.light, set.transfers, first, values);
    for (int trial = 0; trial < kTrials; ++trial) {
      for (std::size_t i = 0; i < std::min(hidden, n); ++i)
        std::swap(order[i], order[i + random() % (n - i)]);
      glm::dvec3 taken(0.0), left = set.light;
      for (std::size_t i = 0; i < std::min(hidden, n); ++i) {
        taken += glm::dvec3(values[order[i]]);
        left -= glm::dvec3(set.transfers[order[i]]);
      }
      const glm::dvec3 error = (tone.value(set.light) - taken) - tone.value(left);
      sum += error;
      squares += error * error;
      count += 1.0;
    }
  }
  const glm::dvec3 mean = sum / count;
  return squares / count - mean * mean;
}

void run(const char* file, const char* rows) {
  const pipeline::LitScene scene = read_lit_scene(file);
  const std::vector<DataSet> sets = data_sets(scene);
  std::ofstream out;
  if (rows) out.open(rows);
  std::mt19937 random(1);
  fmt::print("variance of the error (values squared, mean of r, g, b) by hidden patches of {}\n",
             kSources);
  fmt::print("| sets | 0 | 5 | 10 | 15 | 20 | 25 | 30 | 35 | 40 | 45 | 50 |\n");
  for (const double share : {0.0, 0.25, 0.5}) {
    fmt::print("| {:.0f} / {:.0f} |", 100 * share, 100 - 100 * share);
    for (std::size_t hidden = 0; hidden <= kSources; ++hidden) {
      const glm::dvec3 v = variance(scene.tone, sets, share, hidden, random);
      if (hidden % 5 == 0) fmt::print(" {:.2f} |", (v.x + v.y + v.z) / 3.0);
      if (out) out << share << ' ' << hidden << ' ' << v.x << ' ' << v.y << ' ' << v.z << '\n';
    }
    fmt::print("\n");
    if (out) out << "\n\n";
  }
}

}  // namespace
}  // namespace gnomon::ar

int main(int argc, char** argv) {
  try {
    if (argc < 2 || argc > 3) throw std::runtime_error("usage: measure_intensity LIT_SCENE [ROWS]");
    gnomon::ar::run(argv[1], argc == 3 ? argv[2] : nullptr);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "measure_intensity: %s\n", error.what());
    return 1;
  }
}
