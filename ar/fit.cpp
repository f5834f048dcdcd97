#include "ar/fit.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "ar/error.h"
#include "ar/file.h"
#include "ar/median.h"

namespace gnomon::ar {

namespace {

/// An option that has nothing to count is tried only if it takes so much less of the exact one's
/// time: less than that, two measurements of one thing differ by.
constexpr double kWorthwhile = 0.05;
/// And more than so many times what a frame's time varies by (median absolute deviation).
constexpr double kTimesNoise = 3.0;

struct Saving {
  double ms = 0.0, noise_ms = 0.0, of_ms = 0.0;
};

bool is_worthwhile(const Saving& saved) {
  return saved.ms > std::max(kWorthwhile * saved.of_ms, kTimesNoise * saved.noise_ms);
}

std::unique_ptr<FitDrawing> make_drawing(const SceneFile& file,
                                         std::vector<NamedPicture> photographs,
                                         const FitOptions& options) {
  if (!photographs.empty())
    return draw_in_photographs(file, std::move(photographs), options.lit_scene, options.threads);
  if (file.differential)
    throw InputError(fmt::format("{}: [differential]: its shadows fall on a photograph: give one",
                                 one_line(file.file.string())));
  return draw_by_itself(file, options.threads);
}

/// An item, and what was measured of it alone.
struct Measured {
  FitItem item;
  double saves_ms = 0.0;
};

struct Found {
  FitScene scene;
  std::vector<FitFinding> findings = {};
};

/// Which item takes first of the error that is allowed. What saves most is the natural order; but
/// where the first item takes all, the others can have nothing. The list has models first, and of
/// differential shadows the sources before the passes that are made of them.
enum class Order { most_first, as_listed };
constexpr Order kOrders[] = {Order::most_first, Order::as_listed};

std::vector<std::size_t> in_order(const std::vector<Measured>& items, Order order) {
  std::vector<double> keys;
  for (std::size_t i = 0; i < items.size(); ++i) {
    keys.push_back(order == Order::most_first ? -items[i].saves_ms : 0.0);
    // A phantom is looked at before its shadow, which goes with it.
    for (std::size_t j = 0; j < i; ++j)
      if (items[i].item.object && items[j].item.object == items[i].item.object)
        keys[i] = std::max(keys[i], keys[j]);
  }
  std::vector<std::size_t> indices(items.size());
  std::iota(indices.begin(), indices.end(), std::size_t{0});
  std::stable_sort(indices.begin(), indices.end(),
                   [&](std::size_t a, std::size_t b) { return keys[a] < keys[b]; });
  return indices;
}

}  // namespace

struct Fitter::Impl {
  FitOptions options;
  FitScene given, exact;
  std::vector<std::string> notes;
  std::unique_ptr<FitDrawing> drawing;
  std::vector<Image> reference, untouched;
  std::size_t most_passes = 0, drawn = 0;
  /// Of the progress that is told.
  std::size_t step = 0, steps = 0;
  bool photographs;

  Impl(const SceneFile& file, std::vector<NamedPicture> pictures, const FitOptions& o)
      : options(o), photographs(!pictures.empty()) {
    given = load_fit_scene(file, &notes);
    if (photographs && file.differential && !o.lit_scene.empty())
      given.file.differential->lit_scene = o.lit_scene;
    exact = exact_scene(given);
    drawing = make_drawing(file, std::move(pictures), options);
    FitPictures whole = draw(exact);
    reference = std::move(whole.pictures);
    most_passes = whole.passes;
    untouched = drawing->untouched(exact);
  }

  FitPictures draw(const FitScene& scene) {
    ++drawn;
    return drawing->draw(scene);
  }

  double error_in(const std::vector<Image>& pictures) const {
    double error = 0.0;
    for (std::size_t i = 0; i < pictures.size(); ++i)
      error = std::max(error,
                       picture_error(options.bound.unit, reference[i], pictures[i], untouched[i]));
    return error;
  }

  double error_of(const FitScene& scene) { return error_in(draw(scene).pictures); }

  FitState state_of(const FitScene& scene) {
    const FitPictures pictures = draw(scene);
    return {.error = error_in(pictures.pictures),
            .ms = 0.0,
            .passes = pictures.passes,
            .totals = fit_totals(scene)};
  }

  FitScene given_with(const FitOption& option) const {
    FitScene scene = given;
    option.apply(scene);
    return scene;
  }

  /// How much less time a frame takes by the second scene than by the first. They are drawn in
  /// turns, so that a machine that becomes slower does so for both.
  Saving saving(const FitScene& from, const FitScene& to) {
    draw(from);
    draw(to);
    std::vector<double> before, after, between;
    for (int i = 0; i < options.repeat; ++i) {
      before.push_back(draw(from).ms);
      after.push_back(draw(to).ms);
      between.push_back(before.back() - after.back());
    }
    Saving saving{.ms = median(between), .noise_ms = 0.0, .of_ms = median(before)};
    for (double& difference : between) difference = std::abs(difference - saving.ms);
    saving.noise_ms = median(std::move(between));
    return saving;
  }

  /// Options that have nothing to count: those that are faster than the given one beyond doubt, the
  /// fastest first, then the given one, then the exact one unless that is the given one. Returns
  /// what the fastest saves.
  double order_by_time(FitItem& item) {
    const FitOption given_one = item.options[item.given], exact_one = item.options.back();
    std::vector<std::pair<double, FitOption>> worthwhile;
    for (std::size_t i = 0; i < item.options.size(); ++i) {
      if (i == item.given) continue;
      const Saving saved = saving(given, given_with(item.options[i]));
      if (is_worthwhile(saved)) worthwhile.emplace_back(saved.ms, item.options[i]);
    }
    std::stable_sort(worthwhile.begin(), worthwhile.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    item.options.clear();
    for (const auto& [ms, option] : worthwhile) item.options.push_back(option);
    item.given = item.options.size();
    item.options.push_back(given_one);
    // What is exact ends the search, whatever else is given.
    const auto exact_at = std::ranges::find(item.options, exact_one.name, &FitOption::name);
    if (exact_at == item.options.end())
      item.options.push_back(exact_one);
    else
      item.options.erase(exact_at + 1, item.options.end());
    item.given = std::min(item.given, item.options.size());
    return worthwhile.empty() ? 0.0 : worthwhile.front().first;
  }

  /// Each measured alone.
  std::vector<Measured> measured_items() {
    const FitSurvey survey{
        .photographs = photographs, .placed = drawing->placed(), .passes = most_passes};
    std::vector<FitItem> all = fit_items(given, survey);
    steps = (1 + std::size(kOrders)) * all.size();
    std::vector<Measured> items;
    for (FitItem& item : all) {
      tell_next();
      item.given_name = item.options[item.given].name;
      item.given_amount = item.options[item.given].amount;
      Measured next{.item = std::move(item)};
      next.saves_ms = next.item.unit.empty()
                          ? order_by_time(next.item)
                          : saving(given, given_with(next.item.options.front())).ms;
      items.push_back(std::move(next));
    }
    return items;
  }

  void tell_next() {
    if (options.progress) options.progress(std::min(step++, steps), steps);
  }

  /// The least option with which the whole picture stays within the bound goes into `scene`.
  void reduce(const FitItem& item, FitScene& scene, FitFinding& finding) {
    std::size_t taken = item.options.size() - 1;
    for (std::size_t i = 0; i < taken; ++i) {
      FitScene trial = scene;
      item.options[i].apply(trial);
      const double error = error_of(trial);
      if (error <= options.bound.value) {
        taken = i;
        break;
      }
      finding.next = item.options[i].name;
      finding.next_error = error;
    }
    item.options[taken].apply(scene);
    finding.taken = item.options[taken].name;
    finding.taken_amount = item.options[taken].amount;
    const bool dropped = item.object && !scene.objects[*item.object].kept;
    finding.outcome = dropped               ? "dropped"
                      : taken < item.given  ? "reduced"
                      : taken == item.given ? "kept"
                                            : "raised";
  }

  /// One item after another, from the exact scene on.
  Found reduce_all(const std::vector<Measured>& items, Order order) {
    Found found{.scene = exact};
    for (const std::size_t i : in_order(items, order)) {
      tell_next();
      const FitItem& item = items[i].item;
      const bool gone = item.object && !found.scene.objects[*item.object].kept;
      FitFinding finding{.item = item.name,
                         .unit = item.unit,
                         .given = item.given_name,
                         .taken = "nothing",
                         .given_amount = item.given_amount,
                         .saves_ms = items[i].saves_ms,
                         .outcome = "gone with the phantom"};
      if (!gone) reduce(item, found.scene, finding);
      found.findings.push_back(std::move(finding));
    }
    return found;
  }

  /// Of all orders' results the one whose frame is the fastest; the first where that is in doubt.
  Found best_of_orders(const std::vector<Measured>& items) {
    Found best = reduce_all(items, kOrders[0]);
    for (const Order order : std::span(kOrders).subspan(1)) {
      Found other = reduce_all(items, order);
      if (is_worthwhile(saving(best.scene, other.scene))) best = std::move(other);
    }
    return best;
  }

  FitResult search() {
    step = 0;
    Found found = best_of_orders(measured_items());
    FitResult result{.given = given,
                     .fitted = std::move(found.scene),
                     .findings = std::move(found.findings),
                     .notes = notes};
    for (const SceneObject& object : given.file.objects)
      if (!drawing->placed().contains(object.name)) result.left_out.push_back(object.name);
    const Saving saved = saving(given, result.fitted);
    result.before = state_of(given);
    result.after = state_of(result.fitted);
    result.before.ms = saved.of_ms;
    result.after.ms = saved.of_ms - saved.ms;
    if (!(result.after.error <= options.bound.value))
      throw InputError(fmt::format("{}: the result has an error of {}, outside the bound",
                                   one_line(given.file.file.string()),
                                   describe_error(options.bound.unit, result.after.error)));
    result.drawn = drawn;
    return result;
  }
};

Fitter::Fitter(const SceneFile& file, std::vector<NamedPicture> photographs,
               const FitOptions& options)
    : impl_(std::make_unique<Impl>(file, std::move(photographs), options)) {}
Fitter::~Fitter() = default;

FitResult Fitter::search() { return impl_->search(); }
double Fitter::error_of(const FitScene& scene) { return impl_->error_of(scene); }
Image Fitter::show(const FitScene& scene) { return impl_->drawing->show(scene); }

}  // namespace gnomon::ar
