// Differential shadows against photographs of the real thing, and against rays.
// Usage: measure_differential LIT_SCENE CAPTURE TRUTH [OUT]   (folders as in differential_truth.h)
// Prints tables. With OUT: pictures of every setting, references (those that lie there already are
// read and not made again), and contact.png: a row a photograph, of photograph, 50 passes,
// reference, and the FLIP errors of these two. A reference belongs to its lit scene: take another
// OUT for another one.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "ar/differential_augment.h"
#include "ar/flip.h"
#include "ar/image_file.h"
#include "ar/stopwatch.h"
#include "differential_truth.h"

namespace gnomon::ar {
namespace {

namespace fs = std::filesystem;
using pipeline::ShadowMask;
using pipeline::ShadowPrecision;

constexpr std::size_t kAll = 1'000'000;
constexpr int kTimedFrames = 11;

struct Setting {
  std::string name;
  DifferentialSettings settings;
};

std::string named(std::size_t passes, const std::string& more) {
  return (passes == kAll ? "all" : std::to_string(passes)) + more;
}

std::vector<Setting> settings() {
  std::vector<Setting> out;
  const auto add = [&](std::size_t passes, const std::string& more) -> DifferentialSettings& {
    DifferentialSettings& settings = out.emplace_back(Setting{named(passes, more), {}}).settings;
    settings.method.take.passes = passes;
    settings.masks = false;
    return settings;
  };
  for (const std::size_t n :
       {std::size_t{5}, std::size_t{10}, std::size_t{20}, std::size_t{50}, std::size_t{100}, kAll})
    add(n, "");
  for (const std::size_t n : {std::size_t{10}, std::size_t{20}, std::size_t{50}})
    add(n, " maps").method.mask = ShadowMask::map;
  for (const std::size_t n : {std::size_t{50}, kAll}) {
    add(n, " dithered").method.take.precision = ShadowPrecision::dithered;
    add(n, " values").method.take.precision = ShadowPrecision::values;
    add(n, " radiance").method.take.precision = ShadowPrecision::radiance;
  }
  add(50, " all triangles").occluder_triangles = 0;
  add(50, " 100 triangles").occluder_triangles = 100;
  add(50, " whole clusters").method.take.whole_clusters = true;
  add(50, " pruned shafts dropped").light.drop_pruned = true;
  add(50, " black objects").method.take.returned_light = false;
  add(50, " one amount").method.take.by_share = false;
  DifferentialSettings& paper = add(50, " as in the paper");
  paper.method.take.returned_light = paper.method.take.by_share = false;
  paper.method.take.whole_clusters = true;
  paper.method.mask = ShadowMask::map;
  paper.light.drop_pruned = true;
  DifferentialSettings& most = add(kAll, " of all power, radiance");
  most.method.take.precision = ShadowPrecision::radiance;
  most.light.transfer.power_share = 1.0;
  return out;
}

/// A photograph with what is held against it.
struct Case {
  const Truth* truth;
  pipeline::ReferencePicture reference;
  std::vector<std::size_t> region;
  /// One value a region's pixel and nothing else.
  Image mask;
};

Image region_mask(const std::vector<std::size_t>& region, const Image& like) {
  Image mask{like.width, like.height, 1, {}};
  mask.pixels.resize(static_cast<std::size_t>(like.width) * like.height);
  for (const std::size_t i : region) mask.pixels[i] = 255;
  return mask;
}

double flip_error(const Image& photo, const Image& test, const Image& mask) {
  return mean_error(flip(photo, test), &mask);
}

Image with_pixels(const Image& like, const std::vector<std::uint8_t>& pixels) {
  Image out = like;
  out.pixels = pixels;
  return out;
}

std::vector<Case> reference_table(const TruthSet& set, const fs::path& out) {
  const std::vector<pipeline::Ray> rays = photo_rays(set);
  const Image& background = set.background;
  fmt::print(
      "| photograph | pixels | RMSE without a shadow | of the reference | 1 - ratio | FLIP without "
      "| of the reference | darker by, photograph | reference | s |\n");
  std::vector<Case> cases;
  for (const Truth& truth : set.truths) {
    Stopwatch watch;
    Case& at = cases.emplace_back(Case{&truth, reference_of(set, truth, rays, out), {}, {}});
    const double seconds = watch.lap_ms() / 1000.0;
    at.region = shadow_region(truth, at.reference, background);
    at.mask = region_mask(at.region, background);
    const double without = rmse(background.pixels, truth.photo.pixels, at.region);
    const double with = rmse(at.reference.pixels, truth.photo.pixels, at.region);
    fmt::print(
        "| {} | {} | {:.2f} | {:.2f} | {:.3f} | {:.4f} | {:.4f} | {:.2f} | {:.2f} | {:.1f} |\n",
        truth.name, at.region.size(), without, with, 1.0 - with / without,
        flip_error(truth.photo, background, at.mask),
        flip_error(truth.photo, with_pixels(background, at.reference.pixels), at.mask),
        mean_difference(background.pixels, truth.photo.pixels, at.region),
        mean_difference(background.pixels, at.reference.pixels, at.region), seconds);
    std::fflush(stdout);
  }
  return cases;
}

struct Times {
  double whole_ms = 0.0, record_ms = 0.0, execute_ms = 0.0, composite_ms = 0.0, traverse_ms = 0.0;
};

/// Medians.
Times time_frames(DifferentialAugmenter& augmenter, const TruthSet& set, const Truth& truth) {
  std::vector<double> whole, record, execute, composite, traverse;
  for (int i = 0; i < kTimedFrames; ++i) {
    Stopwatch watch;
    const Augmented out = augmenter.augment(set.background, truth.scene, set.world_from_camera);
    whole.push_back(watch.lap_ms());
    record.push_back(out.record_ms);
    execute.push_back(out.execute_ms);
    composite.push_back(out.composite_ms);
    traverse.push_back(augmenter.report().traverse_ms);
  }
  const auto median = [](std::vector<double>& list) {
    std::sort(list.begin(), list.end());
    return list[list.size() / 2];
  };
  return {median(whole), median(record), median(execute), median(composite), median(traverse)};
}

/// One setting on one photograph.
struct Outcome {
  double ratio = 0.0, reference_ratio = 0.0, flip = 0.0, to_reference = 0.0, darker = 0.0;
  Times times;
  std::size_t shadows = 0, sources = 0;
  Image picture;
};

void print_row(const std::string& setting, const std::string& photograph, const Outcome& o) {
  fmt::print(
      "| {} | {} | {} of {} | {:.3f} | {:.3f} | {:.4f} | {:.2f} | {:.2f} | {:.1f} | {:.2f} | "
      "{:.2f} | {:.2f} | {:.2f} |\n",
      setting, photograph, o.shadows, o.sources, o.ratio, o.reference_ratio, o.flip, o.to_reference,
      o.darker, o.times.whole_ms, o.times.record_ms, o.times.execute_ms, o.times.composite_ms,
      o.times.traverse_ms);
  std::fflush(stdout);
}

Outcome measure(DifferentialAugmenter& augmenter, const TruthSet& set, const Case& at) {
  const Truth& truth = *at.truth;
  const Image& background = set.background;
  Outcome o;
  o.picture = augmenter.augment(background, truth.scene, set.world_from_camera).composite;
  o.times = time_frames(augmenter, set, truth);
  o.shadows = augmenter.report().shadows;
  o.sources = augmenter.report().occluded_sources;
  const double without = rmse(background.pixels, truth.photo.pixels, at.region);
  o.ratio = 1.0 - rmse(o.picture.pixels, truth.photo.pixels, at.region) / without;
  o.reference_ratio = 1.0 - rmse(at.reference.pixels, truth.photo.pixels, at.region) / without;
  o.flip = flip_error(truth.photo, o.picture, at.mask);
  o.to_reference = rmse(o.picture.pixels, at.reference.pixels, at.region);
  o.darker = mean_difference(background.pixels, o.picture.pixels, at.region);
  return o;
}

Outcome mean_of(const std::vector<Outcome>& all) {
  Outcome mean;
  const auto n = static_cast<double>(all.size());
  for (const Outcome& o : all) {
    mean.ratio += o.ratio / n;
    mean.reference_ratio += o.reference_ratio / n;
    mean.flip += o.flip / n;
    mean.to_reference += o.to_reference / n;
    mean.darker += o.darker / n;
    mean.shadows = std::max(mean.shadows, o.shadows);
    mean.sources = std::max(mean.sources, o.sources);
    mean.times.whole_ms += o.times.whole_ms / n;
    mean.times.record_ms += o.times.record_ms / n;
    mean.times.execute_ms += o.times.execute_ms / n;
    mean.times.composite_ms += o.times.composite_ms / n;
    mean.times.traverse_ms += o.times.traverse_ms / n;
  }
  return mean;
}

/// A setting's pictures, one a photograph.
using Pictures = std::map<std::string, std::vector<Image>>;

Pictures settings_table(const TruthSet& set, const std::vector<Case>& cases, const fs::path& out) {
  const Lens lens(set.camera);
  Pictures pictures;
  fmt::print(
      "\n| n | photograph | shadows | 1 - ratio | reference's | FLIP | RMSE to the reference | "
      "darker by | ms: whole | record | execute | composite | traversal |\n");
  for (const Setting& one : settings()) {
    Stopwatch watch;
    DifferentialAugmenter augmenter(lens, set.lit, set.world_from_camera, one.settings);
    const double setup_ms = watch.lap_ms();
    std::vector<Outcome> all;
    for (const Case& at : cases) {
      all.push_back(measure(augmenter, set, at));
      print_row(one.name, at.truth->name, all.back());
      if (!out.empty())
        write_png(out / (at.truth->name + "_" + one.name + ".png"), all.back().picture);
      pictures[one.name].push_back(all.back().picture);
    }
    print_row(one.name, "mean", mean_of(all));
    const pipeline::LightPaths& paths = augmenter.paths();
    fmt::print("{}: {} sources, {} leaf shafts, {} pruned, {:.0f} ms before the first frame\n",
               one.name, paths.transfers.sources.size(), paths.leaf_shafts, paths.pruned_shafts,
               setup_ms);
  }
  return pictures;
}

/// Bytes against what one rounding at the end gives, over every pixel without a virtual object.
void precision_table(const std::vector<Case>& cases, const Pictures& pictures) {
  fmt::print(
      "\n| pictures | beside | mean difference where they differ from the photograph "
      "| mean of its size | largest |\n");
  const auto compare = [&](const std::string& a, const std::string& b) {
    double sum = 0.0, size = 0.0;
    std::size_t count = 0;
    int worst = 0;
    for (std::size_t k = 0; k < cases.size(); ++k) {
      const Image &x = pictures.at(a)[k], &y = pictures.at(b)[k];
      for (const std::size_t i : cases[k].region) {
        for (std::size_t c = 0; c < 3; ++c) {
          const int d = x.pixels[3 * i + c] - y.pixels[3 * i + c];
          sum += d;
          size += std::abs(d);
          worst = std::max(worst, std::abs(d));
          ++count;
        }
      }
    }
    const auto n = static_cast<double>(std::max<std::size_t>(count, 1));
    fmt::print("| {} | {} | {:+.3f} | {:.3f} | {} |\n", a, b, sum / n, size / n, worst);
  };
  for (const std::string n : {"50", "all"}) {
    compare(n, n + " values");
    compare(n, n + " radiance");
    compare(n + " dithered", n + " values");
    compare(n + " values", n + " radiance");
  }
}

/// Of a picture: a part around the shadow, as large as the contact sheet has room for.
struct Crop {
  static constexpr int kWidth = 280, kHeight = 210;
  int x0 = 0, y0 = 0;

  Crop(const std::vector<std::size_t>& region, int width, int height) {
    double x = 0.0, y = 0.0;
    for (const std::size_t i : region) {
      x += static_cast<double>(i % static_cast<std::size_t>(width));
      y += static_cast<double>(i / static_cast<std::size_t>(width));
    }
    const auto count = static_cast<double>(std::max<std::size_t>(region.size(), 1));
    x0 = std::clamp(static_cast<int>(x / count) - kWidth / 2, 0, std::max(0, width - kWidth));
    y0 = std::clamp(static_cast<int>(y / count) - kHeight / 2, 0, std::max(0, height - kHeight));
  }
};

void paste(Image& sheet, const Image& picture, const Crop& crop, int x, int y) {
  for (int row = 0; row < std::min(Crop::kHeight, picture.height); ++row)
    std::copy_n(picture.at(crop.x0, crop.y0 + row), 3 * std::min(Crop::kWidth, picture.width),
                sheet.at(x, y + row));
}

void write_contact_sheet(const fs::path& file, const std::vector<Case>& cases,
                         const Pictures& pictures) {
  Image sheet{5 * Crop::kWidth, static_cast<int>(cases.size()) * Crop::kHeight, 3, {}};
  sheet.pixels.resize(std::size_t{3} * sheet.width * sheet.height);
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const Image& photo = cases[k].truth->photo;
    const Image& ours = pictures.at("50")[k];
    const Image reference = with_pixels(photo, cases[k].reference.pixels);
    const Image errors[] = {error_picture(flip(photo, ours)),
                            error_picture(flip(photo, reference))};
    const Crop crop(cases[k].region, photo.width, photo.height);
    int x = 0;
    for (const Image* one : {&photo, &ours, &reference, &errors[0], &errors[1]}) {
      paste(sheet, *one, crop, x, static_cast<int>(k) * Crop::kHeight);
      x += Crop::kWidth;
    }
  }
  write_png(file, sheet);
}

void run(const TruthSet& set, const fs::path& out) {
  const std::vector<Case> cases = reference_table(set, out);
  const Pictures pictures = settings_table(set, cases, out);
  precision_table(cases, pictures);
  if (!out.empty()) write_contact_sheet(out / "contact.png", cases, pictures);
}

}  // namespace
}  // namespace gnomon::ar

int main(int argc, char** argv) {
  try {
    if (argc < 4 || argc > 5)
      throw std::runtime_error("usage: measure_differential LIT_SCENE CAPTURE TRUTH [OUT]");
    const std::filesystem::path out = argc == 5 ? argv[4] : "";
    if (!out.empty()) std::filesystem::create_directories(out);
    gnomon::ar::run(gnomon::ar::read_truths(argv[1], argv[2], argv[3]), out);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "measure_differential: %s\n", error.what());
    return 1;
  }
}
