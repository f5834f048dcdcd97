#include "testing/matchers.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <ostream>
#include <utility>

#include "raster/stencil_text.h"
#include "testing/difference.h"

namespace gnomon::testing {

namespace {

/// Values as characters, where they have some.
std::vector<Column> columns(const raster::StencilBuffer& actual,
                            const raster::StencilBuffer& expected) {
  std::vector<Column> both{{"expected", {}}, {"actual", {}}};
  for (const std::uint8_t value : expected.to_rows())
    both[0].glyphs += raster::stencil_glyph(value);
  for (const std::uint8_t value : actual.to_rows()) both[1].glyphs += raster::stencil_glyph(value);
  return both;
}
template <class Buffer>
std::vector<Column> columns(const Buffer&, const Buffer&) {
  return {};
}

std::string place(const DifferenceMap::Pixel& pixel) {
  return "(" + std::to_string(pixel.x) + ", " + std::to_string(pixel.y) + ")";
}

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.9g", value);
  return text.data();
}

template <class Buffer>
class Equals : public ::testing::MatcherInterface<const Buffer&> {
 public:
  Equals(const Buffer& expected, std::optional<raster::StencilBuffer> mask, std::uint32_t units)
      : expected_(expected), mask_(std::move(mask)), units_(units) {
    if (!mask_) return;
    raster::require(mask_->width() == expected.width() && mask_->height() == expected.height(),
                    "a mask has the size of the buffer it is laid over");
    const std::vector<std::uint8_t> rows = mask_->to_rows();
    raster::require(std::any_of(rows.begin(), rows.end(), [](std::uint8_t m) { return m != 0; }),
                    "a mask picks at least one pixel");
  }

  bool MatchAndExplain(const Buffer& actual,
                       ::testing::MatchResultListener* listener) const override {
    if (kind(actual) != kind(expected_)) {
      *listener << "which is a " << kind(actual) << ", not a " << kind(expected_);
      return false;
    }
    DifferenceMap map(actual.width(), actual.height());
    for (int y = 0; y < actual.height(); ++y)
      for (int x = 0; x < actual.width(); ++x)
        if (!mask_ || mask_->at(x, y)) map.add(x, y, difference(actual, expected_, x, y, units_));
    if (map.differing() == 0) return true;
    if (listener->IsInterested()) explain(actual, map, *listener->stream());
    return false;
  }

  void DescribeTo(std::ostream* out) const override { describe("equals", *out); }
  void DescribeNegationTo(std::ostream* out) const override { describe("does not equal", *out); }

 private:
  void describe(const char* verb, std::ostream& out) const {
    out << verb;
    if (units_) out << ", to within " << unit_count();
    if (mask_) out << ", under a mask";
    if (units_ || mask_) out << ',';
    std::string text = ::testing::PrintToString(expected_);
    if (text.back() == '\n') text.pop_back();
    out << " a " << text;
  }

  void explain(const Buffer& actual, const DifferenceMap& map, std::ostream& out) const {
    const DifferenceMap::Pixel first = map.first(), largest = map.largest();
    out << "which differs";
    if (units_) out << " by more than " << unit_count();
    out << " at " << map.differing() << " of " << map.compared() << " pixels";
    if (mask_) out << " under the mask";
    out << "\nfirst at " << place(first) << ": " << value(actual, first.x, first.y) << ", expected "
        << value(expected_, first.x, first.y) << "\nlargest difference "
        << number(map.largest_magnitude()) << ", at " << place(largest) << '\n'
        << map.picture(columns(actual, expected_));
  }

  std::string unit_count() const {
    return std::to_string(units_) + (units_ == 1 ? " unit" : " units");
  }

  Buffer expected_;
  std::optional<raster::StencilBuffer> mask_;
  std::uint32_t units_;
};

template <class Buffer>
::testing::Matcher<const Buffer&> equals(const Buffer& expected,
                                         std::optional<raster::StencilBuffer> mask = {},
                                         std::uint32_t units = 0) {
  return ::testing::MakeMatcher(new Equals<Buffer>(expected, std::move(mask), units));
}

}  // namespace

StencilMatcher StencilEquals(const raster::StencilBuffer& expected) { return equals(expected); }

StencilMatcher StencilIs(std::string_view text) { return equals(stencil_of(text)); }

DepthMatcher DepthEquals(const raster::DepthBuffer& expected, std::uint32_t units) {
  return equals(expected, {}, units);
}

ColorMatcher ColorEquals(const raster::ColorBuffer& expected) { return equals(expected); }

StencilMatcher EqualUnderMask(const raster::StencilBuffer& expected,
                              const raster::StencilBuffer& mask) {
  return equals(expected, mask);
}

DepthMatcher EqualUnderMask(const raster::DepthBuffer& expected, const raster::StencilBuffer& mask,
                            std::uint32_t units) {
  return equals(expected, mask, units);
}

ColorMatcher EqualUnderMask(const raster::ColorBuffer& expected,
                            const raster::StencilBuffer& mask) {
  return equals(expected, mask);
}

}  // namespace gnomon::testing
