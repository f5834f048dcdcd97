// gnomon compare: how much two pictures differ.
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "apps/commands.h"
#include "ar/error.h"
#include "ar/flip.h"
#include "ar/image_file.h"
#include "ar/metrics.h"

namespace gnomon::apps {
namespace {

struct Options {
  std::string reference, test, mask, flip_map;
  double pixels_per_degree = ar::kDefaultPixelsPerDegree;
  bool json = false;
};

/// What the command says; absent is what a pair of pictures does not have.
struct Result {
  int width = 0, height = 0;
  bool linear_light = false;
  std::int64_t pixels = 0, differing = 0;
  double largest = 0.0, rmse = 0.0, flip = 0.0;
  std::optional<double> iou, psnr, ssim;
};

bool is_linear_light(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  return extension == ".exr" || extension == ".hdr";
}

template <class Reference, class Picture>
void require_size(const Reference& reference, const std::string& reference_path,
                  const Picture& picture, const std::string& path) {
  if (picture.width == reference.width && picture.height == reference.height) return;
  throw ar::InputError(fmt::format("{}: is {}x{} pixels, but {} is {}x{}", path, picture.width,
                                   picture.height, reference_path, reference.width,
                                   reference.height));
}

/// The mask of the command line, or nothing.
template <class Reference>
std::optional<ar::Image> read_mask(const Options& options, const Reference& reference) {
  if (options.mask.empty()) return std::nullopt;
  ar::Image mask = ar::read_image(options.mask);
  require_size(reference, options.reference, mask, options.mask);
  for (int y = 0; y < mask.height; ++y) {
    for (int x = 0; x < mask.width; ++x) {
      if (ar::picked(&mask, x, y)) return mask;
    }
  }
  throw ar::InputError(fmt::format("{}: no pixel is {} or more, so there is nothing to compare",
                                   options.mask, ar::kMaskThreshold));
}

double finish_flip(const ar::ErrorMap& map, const ar::Image* mask, const Options& options) {
  if (!options.flip_map.empty()) ar::write_png(options.flip_map, ar::error_picture(map));
  return ar::mean_error(map, mask);
}

Result compare_linear_light(const Options& options) {
  const ar::FloatImage a = ar::read_float_image(options.reference);
  const ar::FloatImage b = ar::read_float_image(options.test);
  require_size(a, options.reference, b, options.test);
  const std::optional<ar::Image> mask = read_mask(options, a);
  const ar::Image* under = mask ? &*mask : nullptr;
  const ar::FloatDifference d = ar::difference(a, b, under);
  Result result{a.width, a.height, true, d.pixels, d.differing, d.largest, d.rmse};
  result.flip = finish_flip(ar::flip_hdr(a, b, ar::hdr_exposures(a), options.pixels_per_degree),
                            under, options);
  return result;
}

Result compare_pictures(const Options& options) {
  const ar::Image a = ar::read_image(options.reference);
  const ar::Image b = ar::read_image(options.test);
  require_size(a, options.reference, b, options.test);
  const std::optional<ar::Image> mask = read_mask(options, a);
  const ar::Image* under = mask ? &*mask : nullptr;
  const ar::Difference d = ar::difference(a, b, under);
  Result result{a.width, a.height, false, d.pixels, d.differing, double(d.largest), d.rmse};
  result.iou = ar::mask_iou(a, b, under);
  if (std::isfinite(d.psnr)) result.psnr = d.psnr;
  result.ssim = ar::ssim(a, b, under);
  result.flip = finish_flip(ar::flip(a, b, options.pixels_per_degree), under, options);
  return result;
}

void print_json(const Result& r) {
  const auto or_null = [](const std::optional<double>& value) {
    return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
  };
  nlohmann::ordered_json line;
  line["width"] = r.width;
  line["height"] = r.height;
  line["pixels"] = r.pixels;
  line["differing"] = r.differing;
  line["largest"] = r.largest;
  line["iou"] = or_null(r.iou);
  line["rmse"] = r.rmse;
  line["psnr"] = or_null(r.psnr);
  line["ssim"] = or_null(r.ssim);
  line["flip"] = r.flip;
  line["linear_light"] = r.linear_light;
  std::cout << line.dump() << '\n';
}

void print_text(const Result& r) {
  std::cout << fmt::format(
      "{}x{} pixels, {} compared, {} differ ({:.3g} %)\n", r.width, r.height, r.pixels, r.differing,
      100.0 * static_cast<double>(r.differing) / static_cast<double>(r.pixels));
  std::cout << fmt::format("largest difference  {:.6g}\nRMSE                {:.6g}\n", r.largest,
                           r.rmse);
  if (r.psnr) std::cout << fmt::format("PSNR                {:.4f} dB\n", *r.psnr);
  if (r.ssim) std::cout << fmt::format("SSIM                {:.6f}\n", *r.ssim);
  std::cout << fmt::format("FLIP                {:.6f}\n", r.flip);
  if (r.iou) std::cout << fmt::format("IoU                 {:.6f}\n", *r.iou);
}

void compare(const Options& options) {
  const bool linear = is_linear_light(options.reference) && is_linear_light(options.test);
  const Result result = linear ? compare_linear_light(options) : compare_pictures(options);
  options.json ? print_json(result) : print_text(result);
}

}  // namespace

void add_compare(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("compare", "Say how much two pictures differ");
  command->add_option("A", options->reference, "Reference picture")->required();
  command->add_option("B", options->test, "Picture of the same size")->required();
  command->add_option("--mask", options->mask,
                      "Compare only where this picture's first channel is 128 or more");
  command->add_option("--flip-map", options->flip_map, "Write FLIP's error map here (PNG, magma)");
  command
      ->add_option("--ppd", options->pixels_per_degree,
                   "Pixels in a degree of the viewer's field, for FLIP")
      ->check(CLI::Range(1.0, 1000.0))
      ->capture_default_str();
  command->add_flag("--json", options->json, "Print one line of JSON");
  command->footer(
      "Values of RMSE are 0 to 255; of two EXR or HDR pictures they are in the files' own unit, "
      "and\n"
      "FLIP is the one for high dynamic range. IoU is of two grey pictures, set from 128 upwards.\n"
      "In JSON, null is what the pair does not have (PSNR of equal pictures, IoU of coloured "
      "ones).\n"
      "\n"
      "Examples:\n"
      "  gnomon compare photograph.png composite.png --mask shadow_region.png\n"
      "  gnomon compare true_shadow.png shadow_mask.png --json --flip-map error.png");
  command->callback([options] { compare(*options); });
}

}  // namespace gnomon::apps
