// measure_depth: how far the depths of gnomon and of Mesa's two software drivers are from exact
// rational ones, on the same triangles. docs/depth.md holds what it prints. Each renderer runs in a
// process of its own, because Mesa chooses its driver once a process.
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "depth_batches.h"
#include "peer/osmesa/osmesa_context.h"
#include "replay.h"

namespace gnomon::peer {

namespace {

using depth_batches::Batch;
using depth_batches::Drawn;
using depth_batches::Kind;
using depth_batches::Measured;
using nlohmann::json;

struct Options {
  std::int64_t triangles = 1000000;
  std::uint32_t seed = 1;
  std::vector<std::string> renderers{"gnomon", "llvmpipe", "softpipe"};
  std::string json_file;
};

/// Of a thousand triangles that cover a pixel, half of them with polygon offset.
int share(Kind kind) {
  constexpr std::array<int, 8> kShares{500, 120, 100, 30, 120, 30, 80, 20};
  return kShares.at(static_cast<std::size_t>(kind));
}

/// Draws batches and reads them back.
class Renderer {
 public:
  explicit Renderer(const std::string& name) : name_(name) {
    if (name == "gnomon") return;
    setenv("GALLIUM_DRIVER", name.c_str(), 1);
    setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
  }

  Drawn draw(const Batch& batch) {
    if (name_ == "gnomon") return depth_batches::draw(batch, {.threads = 1});
    const int width = batch.view.width, height = batch.view.height;
    if (!context_ || context_->width() != width || context_->height() != height) {
      context_.reset();
      context_ = std::make_unique<OsmesaContext>(width, height);
      if (!context_->renderer().starts_with(name_))
        throw std::runtime_error("Mesa gives " + context_->renderer() + " for " + name_);
      version_ = context_->renderer() + ", " + context_->version();
      depth_ = std::make_unique<raster::DepthBuffer>(width, height);
      stencil_ = std::make_unique<raster::StencilBuffer>(width, height);
    }
    raster::Frame frame;
    depth_batches::record(batch, frame, {.depth = depth_.get(), .stencil = stencil_.get()});
    for (const raster::Pass& pass : frame.passes()) replay(*context_, pass, nullptr);
    Buffers buffers = read_back(*context_);
    return {std::move(buffers.depth), std::move(buffers.stencil)};
  }

  /// What OpenGL says it is; gnomon says its name.
  const std::string& version() const { return version_.empty() ? name_ : version_; }

 private:
  std::string name_, version_;
  std::unique_ptr<OsmesaContext> context_;
  std::unique_ptr<raster::DepthBuffer> depth_;
  std::unique_ptr<raster::StencilBuffer> stencil_;
};

json to_json(const exact_depth::Errors& errors) {
  return {{"pixels", errors.pixels},
          {"largest", errors.largest},
          {"mean", errors.mean()},
          {"beyond_one_unit", errors.beyond_one},
          {"clamped", errors.clamped}};
}

json to_json(Kind kind, bool offset, const Measured& m) {
  return {{"class", depth_batches::name(kind)},    {"offset", offset},
          {"triangles_drawn", m.triangles},        {"triangles", m.visible},
          {"snapped", to_json(m.snapped)},         {"unrounded", to_json(m.unrounded)},
          {"coverage_differs", m.coverage_differs}};
}

/// Batches of one kind until enough of their triangles cover a pixel.
Measured measure_kind(Renderer& renderer, Kind kind, bool offset, std::uint64_t wanted,
                      std::uint32_t seed) {
  Measured all;
  while (all.visible < wanted) {
    const Batch batch = depth_batches::make_batch(kind, offset, seed++);
    all.add(depth_batches::measure(batch, renderer.draw(batch), depth_batches::Planes::both));
  }
  return all;
}

json run_renderer(const std::string& name, const Options& options) {
  Renderer renderer(name);
  json rows = json::array();
  const auto start = std::chrono::steady_clock::now();
  for (const Kind kind : depth_batches::kKinds)
    for (const bool offset : {false, true}) {
      const auto wanted =
          static_cast<std::uint64_t>((options.triangles * share(kind) + 1999) / 2000);
      const Measured measured = measure_kind(renderer, kind, offset, wanted, options.seed);
      rows.push_back(to_json(kind, offset, measured));
      const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
      fmt::print(stderr, "{:>6.0f} s  {}: {}{}, {} triangles\n", seconds.count(), name,
                 depth_batches::name(kind), offset ? " with offset" : "", measured.visible);
    }
  return {{"renderer", name}, {"version", renderer.version()}, {"rows", rows}};
}

/// A process that measures one renderer and writes its JSON, or {"error": ...}, to `output`.
struct Child {
  pid_t pid = 0;
  int output = -1;
};

Child start(const std::string& renderer, const Options& options) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) throw std::runtime_error("no pipe for a process");
  const pid_t pid = fork();
  if (pid < 0) throw std::runtime_error("no process for a renderer");
  if (pid > 0) {
    close(ends[1]);
    return {pid, ends[0]};
  }
  close(ends[0]);
  json result;
  try {
    result = run_renderer(renderer, options);
  } catch (const std::exception& e) {
    result = {{"error", renderer + ": " + e.what()}};
  }
  const std::string text = result.dump();
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t written = write(ends[1], text.data() + done, text.size() - done);
    if (written <= 0) _exit(1);
    done += static_cast<std::size_t>(written);
  }
  _exit(0);
}

json finish(const Child& child, const std::string& renderer) {
  std::string text;
  std::array<char, 65536> part{};
  for (ssize_t n = 0; (n = read(child.output, part.data(), part.size())) > 0;)
    text.append(part.data(), static_cast<std::size_t>(n));
  close(child.output);
  waitpid(child.pid, nullptr, 0);
  json result = json::parse(text, nullptr, false);
  if (result.is_discarded()) throw std::runtime_error(renderer + ": its process ended early");
  if (result.contains("error")) throw std::runtime_error(result["error"].get<std::string>());
  return result;
}

/// "largest / mean / share beyond one unit".
std::string cell(const json& errors) {
  const auto pixels = errors["pixels"].get<double>();
  const double beyond = pixels > 0.0 ? errors["beyond_one_unit"].get<double>() / pixels : 0.0;
  const auto number = [](double v) {
    return v < 100.0 ? fmt::format("{:.3f}", v) : fmt::format("{:.0f}", v);
  };
  return fmt::format("{} / {} / {:.2f} %", number(errors["largest"].get<double>()),
                     number(errors["mean"].get<double>()), 100.0 * beyond);
}

/// The sums over a renderer's rows, as one more row.
json total(const json& rows, const char* plane) {
  std::uint64_t triangles = 0, pixels = 0, beyond = 0, clamped = 0;
  double sum = 0.0, largest = 0.0;
  for (const json& row : rows) {
    const json& e = row[plane];
    triangles += row["triangles"].get<std::uint64_t>();
    pixels += e["pixels"].get<std::uint64_t>();
    beyond += e["beyond_one_unit"].get<std::uint64_t>();
    clamped += e["clamped"].get<std::uint64_t>();
    sum += e["mean"].get<double>() * (e["pixels"].get<double>() - e["clamped"].get<double>());
    largest = std::max(largest, e["largest"].get<double>());
  }
  return {{"class", "all"},
          {"triangles", triangles},
          {plane,
           {{"pixels", pixels},
            {"largest", largest},
            {"mean", pixels > clamped ? sum / static_cast<double>(pixels - clamped) : 0.0},
            {"beyond_one_unit", beyond},
            {"clamped", clamped}}}};
}

/// One row of every renderer; the counts are the first one's.
void print_row(const std::vector<json>& rows, const char* plane) {
  const json& first = rows.front();
  const auto offset = first.find("offset");
  const double pixels = first[plane]["pixels"].get<double>();
  const double clamped = first[plane]["clamped"].get<double>();
  fmt::print("| {}{} | {} | {} | {:.0f} % |", first["class"].get<std::string>(),
             offset != first.end() && offset->get<bool>() ? ", offset" : "",
             first["triangles"].dump(), first[plane]["pixels"].dump(),
             pixels > 0.0 ? 100.0 * clamped / pixels : 0.0);
  for (const json& row : rows) fmt::print(" {} |", cell(row[plane]));
  fmt::print("\n");
}

void print_table(const std::vector<json>& results, const char* plane, const char* title) {
  fmt::print("\n{}\n| class | triangles | pixels | clamped |", title);
  for (const json& result : results) fmt::print(" {} |", result["renderer"].get<std::string>());
  fmt::print("\n| --- | --- | --- | --- |");
  for (std::size_t i = 0; i < results.size(); ++i) fmt::print(" --- |");
  fmt::print("\n");
  for (std::size_t i = 0; i < results.front()["rows"].size(); ++i) {
    std::vector<json> row;
    for (const json& result : results) row.push_back(result["rows"][i]);
    print_row(row, plane);
  }
  std::vector<json> totals;
  for (const json& result : results) totals.push_back(total(result["rows"], plane));
  print_row(totals, plane);
}

void print_coverage(const std::vector<json>& results) {
  fmt::print("\nPixels that only the renderer or only the snapped triangles cover:");
  for (const json& result : results) {
    std::uint64_t differs = 0;
    for (const json& row : result["rows"]) differs += row["coverage_differs"].get<std::uint64_t>();
    fmt::print(" {} {}", result["renderer"].get<std::string>(), differs);
  }
  fmt::print("\n");
}

/// The renderers' figures; false if gnomon breaks its promise of one unit.
bool run(const Options& options) {
  std::vector<Child> children;
  for (const std::string& renderer : options.renderers)
    children.push_back(start(renderer, options));
  std::vector<json> results;
  for (std::size_t i = 0; i < children.size(); ++i)
    results.push_back(finish(children[i], options.renderers[i]));
  for (const json& result : results) {
    if (result["renderer"] != result["version"])
      fmt::print("{}\n", result["version"].get<std::string>());
  }
  fmt::print(
      "Cells: largest / mean error in units of D24 / share of pixels beyond one unit;\n"
      "the mean leaves out pixels whose exact depth was clamped\n");
  print_table(results, "snapped", "Against the plane through the snapped vertices");
  print_table(results, "unrounded", "Against the plane through the unrounded vertices");
  print_coverage(results);
  if (!options.json_file.empty()) {
    std::ofstream file(options.json_file);
    file << json{{"seed", options.seed}, {"triangles", options.triangles}, {"results", results}}
                .dump(1)
         << '\n';
    if (!file.flush()) throw std::runtime_error(options.json_file + ": cannot be written");
  }
  for (const json& result : results) {
    if (result["renderer"] == "gnomon" &&
        total(result["rows"], "snapped")["snapped"]["beyond_one_unit"] != 0u)
      return false;
  }
  return true;
}

}  // namespace

}  // namespace gnomon::peer

int main(int argc, char** argv) {
  gnomon::peer::Options options;
  CLI::App app{
      "Measures the depths of gnomon and of Mesa's llvmpipe and softpipe against exact rational "
      "ones, on the same seeded triangles. Exit status 1 if one of gnomon's is more than one unit "
      "of D24 away from the plane through the snapped vertices."};
  app.add_option("--triangles", options.triangles,
                 "How many triangles that cover a pixel each renderer draws")
      ->capture_default_str()
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{100000000}));
  app.add_option("--seed", options.seed, "Of the first batch of each class")->capture_default_str();
  app.add_option("--renderers", options.renderers, "Which to measure, separated by commas")
      ->delimiter(',')
      ->check(CLI::IsMember({"gnomon", "llvmpipe", "softpipe"}))
      ->capture_default_str();
  app.add_option("--json", options.json_file, "A file for the same figures as JSON");
  CLI11_PARSE(app, argc, argv);
  try {
    return gnomon::peer::run(options) ? 0 : 1;
  } catch (const std::exception& e) {
    fmt::print(stderr, "measure_depth: {}\n", e.what());
    return 1;
  }
}
