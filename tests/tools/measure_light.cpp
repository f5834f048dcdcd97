// Prints the tables of docs/capture.md: what gnomon capture finds, beside the truth of a capture
// set that was rendered. Usage: measure_light CAPTURE TRUTH, where CAPTURE holds capture.toml (with
// a mirror ball) and TRUTH response.json, lights.json, background.exr, probe/probe.exr and
// probe/probe_latlong.exr (captures/desk/soft).
#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <opencv2/photo.hpp>

#include "ar/brackets.h"
#include "ar/capture_file.h"
#include "ar/image_file.h"
#include "ar/merge_radiance.h"
#include "ar/mirror_ball.h"
#include "ar/response.h"
#include "ar/response_fit.h"
#include "ar/scene_light.h"
#include "ar/stopwatch.h"

namespace {

namespace fs = std::filesystem;
using namespace gnomon;
using ar::ExposureCurve;

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// The value at which a rising table reaches an exposure.
double value_of(const std::array<double, 256>& table, double exposure) {
  if (exposure <= table[0]) return 0.0;
  if (exposure >= table[255]) return 255.0;
  const auto above = std::upper_bound(table.begin(), table.end(), exposure);
  const auto v = static_cast<double>(above - table.begin() - 1);
  return v + (exposure - above[-1]) / (above[0] - above[-1]);
}

ExposureCurve true_curve(const fs::path& truth) {
  const ar::Response response = ar::read_response(truth / "response.json");
  ExposureCurve curve;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t v = 0; v < 256; ++v)
      curve.exposure_from_value[c][v] = static_cast<double>(response.light_from_value[c][v]);
  return curve;
}

// ---- response

struct CurveError {
  double rms = 0.0, largest = 0.0, rms_inner = 0.0;
};

/// In pixel values, over 1 to 254, once each channel's unit has been fitted.
CurveError error_of(const ExposureCurve& curve, const ExposureCurve& truth) {
  CurveError error;
  int count = 0, inner = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<double> ratios;
    for (std::size_t v = 32; v < 224; ++v)
      ratios.push_back(truth.exposure_from_value[c][v] / curve.exposure_from_value[c][v]);
    const double scale = quantile(std::move(ratios), 0.5);
    for (std::size_t v = 1; v < 255; ++v) {
      const double off =
          value_of(truth.exposure_from_value[c], scale * curve.exposure_from_value[c][v]) -
          static_cast<double>(v);
      error.rms += off * off;
      error.largest = std::max(error.largest, std::abs(off));
      ++count;
      if (v >= 16 && v < 240) {
        error.rms_inner += off * off;
        ++inner;
      }
    }
  }
  error.rms = std::sqrt(error.rms / count);
  error.rms_inner = std::sqrt(error.rms_inner / inner);
  return error;
}

void print_curve(const std::string& name, const ExposureCurve& curve, const ExposureCurve& truth,
                 double ms) {
  const CurveError error = error_of(curve, truth);
  fmt::print("| {} | {:.2f} | {:.2f} | {:.2f} | {:.0f} |\n", name, error.rms, error.rms_inner,
             error.largest, ms);
}

ExposureCurve from_opencv(const cv::Mat& response) {
  ExposureCurve curve;
  for (std::size_t c = 0; c < 3; ++c) {
    auto& table = curve.exposure_from_value[c];
    for (int v = 0; v < 256; ++v) {
      const double exposure = response.at<cv::Vec3f>(v)[static_cast<int>(2 - c)];
      const auto at = static_cast<std::size_t>(v);
      table[at] = v == 0 ? 0.0 : std::max(exposure, table[at - 1] * (1.0 + 1e-6) + 1e-12);
    }
  }
  return curve;
}

void opencv_curves(const std::string& name, const ar::Brackets& set, const ExposureCurve& truth) {
  std::vector<cv::Mat> pictures;
  std::vector<float> times_s;
  for (const ar::Exposure& e : set.exposures) {
    cv::Mat bgr(set.height(), set.width(), CV_8UC3);
    for (int y = 0; y < set.height(); ++y)
      for (int x = 0; x < set.width(); ++x) {
        const std::uint8_t* p = e.picture.at(x, y);
        bgr.at<cv::Vec3b>(y, x) = {p[2], p[1], p[0]};
      }
    pictures.push_back(bgr);
    times_s.push_back(static_cast<float>(e.time_s));
  }
  for (const int samples : {70, 400}) {
    for (const float smoothness : {1.0f, 10.0f, 50.0f}) {
      ar::Stopwatch watch;
      cv::Mat response;
      cv::createCalibrateDebevec(samples, smoothness)->process(pictures, response, times_s);
      print_curve(
          fmt::format("OpenCV Debevec, {} samples, smoothness {:g}, {}", samples, smoothness, name),
          from_opencv(response), truth, watch.lap_ms());
    }
  }
  for (const int rounds : {30, 100}) {
    ar::Stopwatch watch;
    cv::Mat response;
    cv::createCalibrateRobertson(rounds, 1e-4f)->process(pictures, response, times_s);
    print_curve(fmt::format("OpenCV Robertson, {} rounds, {}", rounds, name), from_opencv(response),
                truth, watch.lap_ms());
  }
}

void responses(const ar::Brackets& photograph, const ar::Brackets& probe,
               const ExposureCurve& truth) {
  fmt::print(
      "| response from | rms, 1-254 | rms, 16-239 | largest | ms |\n|---|---|---|---|---|\n");
  const std::vector<ar::Brackets> both{photograph, probe};
  const std::span<const ar::Brackets> sets[] = {both, {&photograph, 1}, {&probe, 1}};
  const char* names[] = {"both sets", "photograph", "probe"};
  for (std::size_t k = 0; k < 3; ++k) {
    for (const double smoothness : {0.01, 1.0, 10.0, 100.0, 1e3, 1e4}) {
      ar::Stopwatch watch;
      const ExposureCurve curve = ar::fit_response(sets[k], {.smoothness = smoothness});
      print_curve(fmt::format("{}, smoothness {:g}", names[k], smoothness), curve, truth,
                  watch.lap_ms());
    }
  }
  if (std::getenv("GNOMON_QUICK") != nullptr) return;
  opencv_curves("photograph", photograph, truth);
  opencv_curves("probe", probe, truth);
}

// ---- radiance

/// Relative errors over pixels, once each channel's unit has been fitted; that unit is returned.
glm::dvec3 compare(const std::string& name, const ar::FloatImage& got, const ar::FloatImage& truth,
                   const std::function<bool(int, int)>& counts) {
  glm::dvec3 scale(1.0);
  std::vector<double> errors;
  for (int c = 0; c < 3; ++c) {
    std::vector<double> ratios;
    const auto each = [&](auto visit) {
      for (int y = 0; y < truth.height; ++y)
        for (int x = 0; x < truth.width; ++x)
          if (counts(x, y) && got.at(x, y)[c] > 0.0f && truth.at(x, y)[c] > 0.0f)
            visit(static_cast<double>(got.at(x, y)[c]), static_cast<double>(truth.at(x, y)[c]));
    };
    each([&](double g, double t) { ratios.push_back(t / g); });
    scale[c] = quantile(std::move(ratios), 0.5);
    each([&](double g, double t) { errors.push_back(std::abs(g * scale[c] / t - 1.0)); });
  }
  fmt::print("| {} | {:.2f} % | {:.2f} % | {:.2f} % |\n", name, 100.0 * quantile(errors, 0.5),
             100.0 * quantile(errors, 0.95), 100.0 * quantile(errors, 0.99));
  return scale;
}

ar::FloatImage opencv_merged(const ar::Brackets& set, const ExposureCurve& curve) {
  std::vector<cv::Mat> pictures;
  std::vector<float> times_s;
  for (const ar::Exposure& e : set.exposures) {
    pictures.emplace_back(set.height(), set.width(), CV_8UC3,
                          const_cast<std::uint8_t*>(e.picture.pixels.data()));
    times_s.push_back(static_cast<float>(e.time_s));
  }
  cv::Mat response(256, 1, CV_32FC3), merged;
  for (int v = 0; v < 256; ++v)
    for (int c = 0; c < 3; ++c)
      response.at<cv::Vec3f>(v)[c] = static_cast<float>(std::max(
          1e-9,
          curve.exposure_from_value[static_cast<std::size_t>(c)][static_cast<std::size_t>(v)]));
  cv::createMergeDebevec()->process(pictures, merged, times_s, response);
  const auto* first = merged.ptr<float>();
  return {set.width(), set.height(), std::vector<float>(first, first + merged.total() * 3)};
}

// ---- patches

void emitters(const ar::SceneLight& light, const glm::dvec3& unit, const fs::path& truth) {
  fmt::print(
      "\n| emitter | measured / true radiance, r g b | power of its surface / true, r g b | "
      "patches |\n"
      "|---|---|---|---|\n");
  const auto lights = nlohmann::json::parse(std::ifstream(truth / "lights.json")).at("lights");
  const pipeline::PatchModel& model = light.scene.model;
  for (const auto& entry : lights) {
    const std::string name = entry.at("name");
    glm::dvec3 sum(0.0);
    double area_m2 = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < model.patches.size(); ++i) {
      if (model.surfaces[model.patches[i].surface] != name) continue;
      sum += model.patches[i].area_m2 * glm::dvec3(light.scene.radiance[i]) * unit;
      area_m2 += model.patches[i].area_m2;
      ++count;
    }
    std::string radiance, power;
    for (std::size_t c = 0; c < 3; ++c) {
      const int k = static_cast<int>(c);
      radiance += fmt::format("{:.3f} ", sum[k] / area_m2 / entry.at("radiance")[c].get<double>());
      power += fmt::format("{:.3f} ",
                           sum[k] * std::numbers::pi / entry.at("radiant_power")[c].get<double>());
    }
    fmt::print("| {} | {} | {} | {} |\n", name, radiance, power, count);
  }
}

/// What reaches the probe's place from all around, and how the map compares with the true one.
void probe_map(const ar::SceneLight& light, const glm::dvec3& unit, const fs::path& truth) {
  const ar::FloatImage latlong = ar::read_float_image(truth / "probe" / "probe_latlong.exr");
  const pipeline::DirectionMap& map = light.scene.probe;
  glm::dvec3 got(0.0), expected(0.0);
  std::vector<double> errors;
  for (int y = 0; y < latlong.height; ++y) {
    const double v = (y + 0.5) / latlong.height, area = std::sin(v * std::numbers::pi);
    for (int x = 0; x < latlong.width; ++x) {
      const double lon = ((x + 0.5) / latlong.width - 0.5) * 2.0 * std::numbers::pi;
      const double lat = (0.5 - v) * std::numbers::pi;
      const glm::dvec3 direction(std::sin(lon) * std::cos(lat), std::sin(lat),
                                 -std::cos(lon) * std::cos(lat));
      const float* p = latlong.at(x, y);
      const glm::dvec3 there(p[0], p[1], p[2]), here = glm::dvec3(map.at(direction)) * unit;
      got += area * here;
      expected += area * there;
      for (int c = 0; c < 3; ++c)
        if (there[c] > 0.0) errors.push_back(std::abs(here[c] / there[c] - 1.0));
    }
  }
  fmt::print(
      "\nprobe map against probe_latlong.exr: median {:.2f} %, 95th percentile {:.1f} %; light "
      "from all directions / true {:.3f} {:.3f} {:.3f}\n",
      100.0 * quantile(errors, 0.5), 100.0 * quantile(errors, 0.95), got.x / expected.x,
      got.y / expected.y, got.z / expected.z);
}

void surfaces(const ar::SceneLight& light, const glm::dvec3& unit) {
  const pipeline::PatchModel& model = light.scene.model;
  fmt::print(
      "\n| surface | patches | radiance r g b (mean) | reflectance r g b (mean) "
      "|\n|---|---|---|---|\n");
  for (std::size_t s = 0; s < model.surfaces.size(); ++s) {
    glm::dvec3 radiance(0.0), reflectance(0.0);
    double area_m2 = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < model.patches.size(); ++i) {
      if (model.patches[i].surface != s) continue;
      radiance += model.patches[i].area_m2 * glm::dvec3(light.scene.radiance[i]) * unit;
      reflectance += model.patches[i].area_m2 * glm::dvec3(light.scene.reflectance[i]);
      area_m2 += model.patches[i].area_m2;
      ++count;
    }
    radiance /= area_m2;
    reflectance /= area_m2;
    fmt::print("| {} | {} | {:.3f} {:.3f} {:.3f} | {:.3f} {:.3f} {:.3f} |\n", model.surfaces[s],
               count, radiance.x, radiance.y, radiance.z, reflectance.x, reflectance.y,
               reflectance.z);
  }
}

void run(const fs::path& folder, const fs::path& truth, bool curves) {
  const ar::CaptureFile capture = ar::read_capture(folder);
  const auto& probe = std::get<ar::BallProbe>(capture.probe);
  const ar::Brackets photograph_set = ar::read_brackets(capture.photograph_brackets);
  const ar::Brackets probe_set = ar::read_brackets(probe.brackets);
  const ExposureCurve curve_truth = true_curve(truth);
  if (curves) responses(photograph_set, probe_set, curve_truth);

  const std::vector<ar::Brackets> both{photograph_set, probe_set};
  const ExposureCurve curve = ar::fit_response(both);
  const ar::FloatImage photograph_exr = ar::read_float_image(truth / "background.exr");
  const ar::FloatImage probe_exr = ar::read_float_image(truth / "probe" / "probe.exr");
  const ar::Lens lens(
      ar::camera_for_picture(ar::read_camera(capture.camera), probe_exr.width, probe_exr.height));
  const auto all = [](int, int) { return true; };
  const auto on_ball = [&](int x, int y) {
    const auto ray = ar::pixel_ray(lens, probe.world_from_camera, glm::dvec2(x, y));
    if (!ray) return false;
    const auto reflection = ar::reflect(probe.ball, *ray);
    return reflection && reflection->cos_incidence > 0.2;
  };
  fmt::print(
      "\n| radiance | median error | 95th percentile | 99th percentile |\n|---|---|---|---|\n");
  const double time_s = *photograph_set.photograph_time_s;
  glm::dvec3 unit =
      compare("photograph against background.exr",
              ar::merge_radiance(photograph_set, curve).picture, photograph_exr, all) /
      time_s;
  const glm::dvec3 probe_unit =
      compare("ball against probe.exr", ar::merge_radiance(probe_set, curve).picture, probe_exr,
              on_ball) /
      time_s;
  compare("photograph, true response", ar::merge_radiance(photograph_set, curve_truth).picture,
          photograph_exr, all);
  compare("ball, true response", ar::merge_radiance(probe_set, curve_truth).picture, probe_exr,
          on_ball);
  compare("photograph, OpenCV's MergeDebevec", opencv_merged(photograph_set, curve), photograph_exr,
          all);
  compare("ball, OpenCV's MergeDebevec", opencv_merged(probe_set, curve), probe_exr, on_ball);
  fmt::print("\nunits of the two / each other: {:.4f} {:.4f} {:.4f}\n", probe_unit.x / unit.x,
             probe_unit.y / unit.y, probe_unit.z / unit.z);

  for (const int rounds : {0, 5, 20, 60, 200}) {
    ar::SceneLightOptions options;
    options.rounds = rounds;
    const ar::SceneLight light = ar::find_scene_light(capture, options);
    fmt::print(
        "\nrounds {}: photograph / probe {:.3f} {:.3f} {:.3f}; {} from photograph, {} probe, {} "
        "filled, {} shine\n",
        rounds, light.photograph_over_probe.x, light.photograph_over_probe.y,
        light.photograph_over_probe.z, light.from_photograph, light.from_probe, light.filled,
        light.emitting);
    emitters(light, unit, truth);
    if (rounds != options.rounds || rounds != 60) continue;
    probe_map(light, unit, truth);
    surfaces(light, unit);
    fmt::print("\n| step | ms |\n|---|---|\n");
    for (const auto& [name, ms] : light.step_ms) fmt::print("| {} | {:.0f} |\n", name, ms);
    for (const std::string& text : light.notes) fmt::print("note: {}\n", text);
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc != 3 && argc != 4)
      throw std::runtime_error("usage: measure_light CAPTURE TRUTH [--curves]");
    run(argv[1], argv[2], argc == 4);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "measure_light: " << error.what() << '\n';
    return 1;
  }
}
