// Median and worst of a set of measurements, as the tables of docs/tracking.md show them.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace gnomon::ar {

class Statistics {
 public:
  void add(double value) { values_.push_back(value); }
  std::size_t count() const { return values_.size(); }

  /// The lower median.
  double median() const { return sorted_at((values_.size() - 1) / 2); }
  double worst() const { return sorted_at(values_.size() - 1); }
  double rms() const {
    double sum = 0.0;
    for (const double v : values_) sum += v * v;
    return values_.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(values_.size()));
  }

  std::string text(int digits = 2) const {
    if (values_.empty()) return "-";
    return fmt::format("{:.{}f} / {:.{}f}", median(), digits, worst(), digits);
  }

 private:
  double sorted_at(std::size_t i) const {
    if (values_.empty()) return 0.0;
    std::vector<double> copy = values_;
    std::sort(copy.begin(), copy.end());
    return copy[i];
  }

  std::vector<double> values_;
};

}  // namespace gnomon::ar
