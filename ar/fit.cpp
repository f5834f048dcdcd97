#include "ar/fit.h"

#include <algorithm>
#include <numeric>
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
struct Ordered {
  FitItem item;
  double saves_ms = 0.0;
};

}  // namespace

struct Fitter::Impl {
  FitOptions options;
  FitScene given, exact;
  std::vector<std::string> notes;
  std::unique_ptr<FitDrawing> drawing;
  std::vector<Image> reference, untouched;
  std::size_t most_passes = 0, drawn = 0;
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

  /// The median time, and what else a frame shows.
  FitState measure(const FitScene& scene) {
    const FitPictures warm = draw(scene);
    std::vector<double> times;
    for (int i = 0; i < options.repeat; ++i) times.push_back(draw(scene).ms);
    return {.error = error_in(warm.pictures),
            .ms = median(std::move(times)),
            .passes = warm.passes,
            .totals = fit_totals(scene)};
  }

  double time_with(const FitOption& option) {
    FitScene scene = given;
    option.apply(scene);
    return measure(scene).ms;
  }

  /// Options that have nothing to count: by time, those that are not worth it left out. The exact
  /// one stays last, and the given one stays.
  double order_by_time(FitItem& item) {
    const std::string exact_name = item.options.back().name,
                      given_name = item.options[item.given].name;
    const double exact_ms = time_with(item.options.back());
    std::vector<std::pair<double, FitOption>> timed;
    for (const FitOption& option : item.options) {
      if (option.name == exact_name) continue;
      const double ms = time_with(option);
      if (ms < (1.0 - kWorthwhile) * exact_ms || option.name == given_name)
        timed.emplace_back(ms, option);
    }
    std::stable_sort(timed.begin(), timed.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    const FitOption last = item.options.back();
    item.options.clear();
    for (auto& [ms, option] : timed)
      if (ms < (1.0 - kWorthwhile) * exact_ms) item.options.push_back(std::move(option));
    // A given option that takes as long as the exact one is no option, but it has a name.
    item.given = item.options.size();
    for (std::size_t i = 0; i < item.options.size(); ++i)
      if (item.options[i].name == given_name) item.given = i;
    item.options.push_back(last);
    return item.options.size() > 1 ? exact_ms - timed.front().first : 0.0;
  }

  /// What saves most comes first, while there is most of the bound left.
  std::vector<Ordered> ordered_items() {
    FitSurvey survey{
        .photographs = photographs, .placed = drawing->placed(), .passes = most_passes};
    std::vector<Ordered> items;
    std::vector<FitItem> all = fit_items(given, survey);
    const double given_ms = measure(given).ms;
    const std::size_t steps = 2 * all.size();
    for (FitItem& item : all) {
      tell(items.size(), steps);
      Ordered next{std::move(item), 0.0};
      next.saves_ms = next.item.unit.empty() ? order_by_time(next.item)
                                             : given_ms - time_with(next.item.options.front());
      items.push_back(std::move(next));
    }
    std::stable_sort(items.begin(), items.end(),
                     [](const Ordered& a, const Ordered& b) { return a.saves_ms > b.saves_ms; });
    return items;
  }

  void tell(std::size_t done, std::size_t all) const {
    if (options.progress) options.progress(done, all);
  }

  /// The least option with which the whole picture stays within the bound goes into `scene`.
  FitFinding reduce(const FitItem& item, FitScene& scene) {
    const FitOption& given_option = item.options[item.given];
    FitFinding finding{.item = item.name,
                       .unit = item.unit,
                       .given = given_option.name,
                       .taken = {},
                       .given_amount = given_option.amount,
                       .taken_amount = 0.0,
                       .saves_ms = 0.0,
                       .next = {},
                       .next_error = 0.0,
                       .outcome = {}};
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
    return finding;
  }

  FitResult search() {
    FitResult result{.given = given,
                     .fitted = exact,
                     .before = {},
                     .after = {},
                     .findings = {},
                     .left_out = {},
                     .notes = notes,
                     .drawn = 0};
    for (const SceneObject& object : given.file.objects)
      if (!drawing->placed().contains(object.name)) result.left_out.push_back(object.name);
    const std::vector<Ordered> items = ordered_items();
    for (std::size_t i = 0; i < items.size(); ++i) {
      tell(items.size() + i, 2 * items.size());
      const FitItem& item = items[i].item;
      const bool gone = item.object && !result.fitted.objects[*item.object].kept;
      FitFinding finding;
      if (gone) {
        finding = {.item = item.name,
                   .unit = item.unit,
                   .given = item.options[item.given].name,
                   .taken = "nothing",
                   .given_amount = item.options[item.given].amount,
                   .taken_amount = 0.0,
                   .saves_ms = 0.0,
                   .next = {},
                   .next_error = 0.0,
                   .outcome = "gone with the phantom"};
      } else {
        finding = reduce(item, result.fitted);
      }
      finding.saves_ms = items[i].saves_ms;
      result.findings.push_back(std::move(finding));
    }
    result.before = measure(given);
    result.after = measure(result.fitted);
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
