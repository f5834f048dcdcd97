#include "apps/study/picture_damage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <glm/common.hpp>

#include "raster/check.h"

namespace gnomon::apps::study {

namespace {

constexpr int kChannels = 3;

std::uint8_t to_value(double v) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(v, 0.0, 255.0)));
}

/// Rows of light, three channels.
std::vector<double> light_of(const ar::Image& picture, const ar::Response& response) {
  std::vector<double> light(picture.pixels.size());
  for (std::size_t i = 0; i < light.size(); ++i)
    light[i] = response.light_from_value[i % kChannels][picture.pixels[i]];
  return light;
}

ar::Image picture_of(int width, int height, const std::vector<double>& light,
                     const ar::Response& response) {
  ar::Image out{width, height, kChannels, {}};
  out.pixels.reserve(light.size());
  for (std::size_t i = 0; i < light.size(); ++i)
    out.pixels.push_back(value_of_light(response, i % kChannels, light[i]));
  return out;
}

std::vector<double> gaussian(double sigma) {
  const int radius = static_cast<int>(std::ceil(3.0 * sigma));
  std::vector<double> weights;
  double sum = 0.0;
  for (int i = -radius; i <= radius; ++i) {
    weights.push_back(std::exp(-0.5 * i * i / (sigma * sigma)));
    sum += weights.back();
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

/// Along x where `step` is a pixel and along y where it is a row; borders go on outside.
std::vector<double> filtered(const std::vector<double>& light, const std::vector<double>& weights,
                             int width, int height, bool along_x) {
  const int radius = static_cast<int>(weights.size()) / 2;
  std::vector<double> out(light.size());
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      std::array<double, kChannels> sum{};
      for (int i = -radius; i <= radius; ++i) {
        const int u = along_x ? std::clamp(x + i, 0, width - 1) : x;
        const int v = along_x ? y : std::clamp(y + i, 0, height - 1);
        const std::size_t from = (static_cast<std::size_t>(v) * width + u) * kChannels;
        const double weight = weights[static_cast<std::size_t>(i + radius)];
        for (std::size_t c = 0; c < kChannels; ++c) sum[c] += weight * light[from + c];
      }
      std::ranges::copy(sum,
                        out.begin() + (static_cast<std::ptrdiff_t>(y) * width + x) * kChannels);
    }
  }
  return out;
}

/// A row or column of means over areas: `count` of them out of `from`.
struct Cell {
  int first = 0;
  std::vector<double> weights;
};

std::vector<Cell> cells(int from, int count) {
  std::vector<Cell> out;
  const double scale = static_cast<double>(from) / count;
  for (int i = 0; i < count; ++i) {
    const double low = i * scale, high = low + scale;
    Cell& cell = out.emplace_back(Cell{static_cast<int>(low), {}});
    for (int at = cell.first; at < from && at < high - 1e-9; ++at)
      cell.weights.push_back((std::min(high, at + 1.0) - std::max<double>(low, at)) / scale);
  }
  return out;
}

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

bool is_inside(const std::array<glm::dvec2, 4>& corners, const glm::dvec2& p) {
  bool left = true, right = true;
  for (std::size_t i = 0; i < 4; ++i) {
    const double side = cross(corners[(i + 1) % 4] - corners[i], p - corners[i]);
    left = left && side >= 0.0;
    right = right && side <= 0.0;
  }
  return left || right;
}

void fill(ar::Image& picture, const std::array<glm::dvec2, 4>& corners) {
  /// Skin in lamplight.
  constexpr std::array<std::uint8_t, kChannels> kColor{150, 110, 80};
  glm::dvec2 low = corners[0], high = corners[0];
  for (const glm::dvec2& corner : corners) {
    low = glm::min(low, corner);
    high = glm::max(high, corner);
  }
  for (int y = std::max(0, static_cast<int>(low.y)); y <= high.y && y < picture.height; ++y)
    for (int x = std::max(0, static_cast<int>(low.x)); x <= high.x && x < picture.width; ++x)
      if (is_inside(corners, {x, y})) std::ranges::copy(kColor, picture.at(x, y));
}

}  // namespace

std::uint8_t value_of_light(const ar::Response& response, std::size_t channel, double light) {
  const auto& table = response.light_from_value[channel];
  const auto above = std::ranges::lower_bound(table, static_cast<float>(light));
  if (above == table.begin()) return 0;
  if (above == table.end()) return 255;
  const auto value = static_cast<std::uint8_t>(above - table.begin());
  return *above - light <= light - *(above - 1) ? value : static_cast<std::uint8_t>(value - 1);
}

ar::Image blurred(const ar::Image& picture, double sigma_px, const ar::Response& response) {
  if (sigma_px <= 0.0) return picture;
  const std::vector<double> weights = gaussian(sigma_px);
  const std::vector<double> rows =
      filtered(light_of(picture, response), weights, picture.width, picture.height, true);
  return picture_of(picture.width, picture.height,
                    filtered(rows, weights, picture.width, picture.height, false), response);
}

ar::Image darkened(const ar::Image& picture, double factor, const ar::Response& response) {
  if (factor == 1.0) return picture;
  std::vector<double> light = light_of(picture, response);
  for (double& value : light) value *= factor;
  return picture_of(picture.width, picture.height, light, response);
}

ar::Image shrunk_to(const ar::Image& picture, int width, const ar::Response& response) {
  raster::require(width <= picture.width && width * picture.height % picture.width == 0,
                  "a picture shrinks to a whole number of rows");
  if (width == picture.width) return picture;
  const int height = width * picture.height / picture.width;
  const std::vector<double> light = light_of(picture, response);
  const std::vector<Cell> columns = cells(picture.width, width),
                          rows = cells(picture.height, height);
  std::vector<double> out;
  for (const Cell& row : rows) {
    for (const Cell& column : columns) {
      std::array<double, kChannels> sum{};
      for (std::size_t v = 0; v < row.weights.size(); ++v) {
        for (std::size_t u = 0; u < column.weights.size(); ++u) {
          const std::size_t from =
              ((row.first + v) * static_cast<std::size_t>(picture.width) + column.first + u) *
              kChannels;
          for (std::size_t c = 0; c < kChannels; ++c)
            sum[c] += row.weights[v] * column.weights[u] * light[from + c];
        }
      }
      out.insert(out.end(), sum.begin(), sum.end());
    }
  }
  return picture_of(width, height, out, response);
}

ar::Image bent(const ar::Image& picture, double gamma) {
  std::array<std::uint8_t, 256> table{};
  for (std::size_t v = 0; v < table.size(); ++v)
    table[v] = to_value(255.0 * std::pow(static_cast<double>(v) / 255.0, gamma));
  ar::Image out = picture;
  for (std::uint8_t& value : out.pixels) value = table[value];
  return out;
}

ar::Image covered(const ar::Image& picture, std::span<const ar::TagCorners> tags, double share,
                  std::size_t side) {
  if (share <= 0.0) return picture;
  /// A white module, of eight that a black square of tag36h11 has.
  constexpr double kBorder = 1.0 / 8.0;
  ar::Image out = picture;
  for (const ar::TagCorners& c : tags) {
    const auto at = [&](double u, double v) {
      const auto corner = [&](std::size_t i) { return c[(i + side) % 4]; };
      return glm::mix(glm::mix(corner(0), corner(1), u), glm::mix(corner(3), corner(2), u), v);
    };
    fill(out, {at(-kBorder, -kBorder), at(share, -kBorder), at(share, 1.0 + kBorder),
               at(-kBorder, 1.0 + kBorder)});
  }
  return out;
}

ar::Image noisy(const ar::Image& picture, double sigma, std::uint32_t seed) {
  if (sigma <= 0.0) return picture;
  // Eight bytes have the mean 1020 and the variance 8 (256^2 - 1) / 12.
  const double scale = sigma / std::sqrt(8.0 * 65535.0 / 12.0);
  std::mt19937 random(seed);
  const auto four_bytes = [&] {
    const auto word = static_cast<std::uint32_t>(random());
    return static_cast<int>((word & 255u) + (word >> 8 & 255u) + (word >> 16 & 255u) +
                            (word >> 24));
  };
  ar::Image out = picture;
  for (std::uint8_t& value : out.pixels) {
    const int first = four_bytes();
    value = to_value(value + scale * (first + four_bytes() - 1020));
  }
  return out;
}

}  // namespace gnomon::apps::study
