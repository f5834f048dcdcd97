#include "pipeline/plane_side.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace gnomon::pipeline {
namespace {

/// A number and what was rounded off it: high + low is exact.
struct Pair {
  double high, low;
};

/// Knuth's sum.
Pair two_sum(double a, double b) {
  const double sum = a + b;
  const double b_part = sum - a, a_part = sum - b_part;
  return {sum, (a - a_part) + (b - b_part)};
}

/// Veltkamp's cut into halves of 26 bits.
Pair split(double a) {
  const double c = 134217729.0 * a;
  const double high = c - (c - a);
  return {high, a - high};
}

/// Dekker's product.
Pair two_product(double a, double b) {
  const double product = a * b;
  const Pair p = split(a), q = split(b);
  const double rest = ((p.high * q.high - product) + p.high * q.low) + p.low * q.high;
  return {product, rest + p.low * q.low};
}

/// A sum of doubles that do not overlap, the smallest first: a number with as many bits as it
/// needs.
class Expansion {
 public:
  void add(double value) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      const Pair sum = two_sum(value, terms_[i]);
      value = sum.high;
      if (sum.low != 0.0) terms_[kept++] = sum.low;
    }
    if (value != 0.0) terms_[kept++] = value;
    size_ = kept;
  }
  void add_product(double a, double b, double c) {
    const Pair ab = two_product(a, b);
    for (const double part : {ab.low, ab.high}) {
      const Pair product = two_product(part, c);
      add(product.low);
      add(product.high);
    }
  }
  int sign() const { return size_ == 0 ? 0 : terms_[size_ - 1] > 0.0 ? 1 : -1; }

 private:
  /// 24 products of four terms each.
  std::array<double, 96> terms_;
  std::size_t size_ = 0;
};

/// Adds dot(s, cross(p, q)).
void add_triple(Expansion& sum, const glm::dvec3& s, const glm::dvec3& p, const glm::dvec3& q) {
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    sum.add_product(p[j], q[k], s[i]);
    sum.add_product(-p[k], q[j], s[i]);
  }
}

int exact_side(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec4& p) {
  // cross(b - a, c - a) = a x b + b x c + c x a, whose product with a is det(a, b, c).
  const glm::dvec3 at(p);
  Expansion sum;
  add_triple(sum, at, a, b);
  add_triple(sum, at, b, c);
  add_triple(sum, at, c, a);
  if (p.w != 0.0) add_triple(sum, -a, b, c);
  return sum.sign();
}

}  // namespace

double largest_minor(const glm::dvec3& p, const glm::dvec3& q) {
  const glm::dvec3 m = glm::abs(p), n = glm::abs(q);
  return std::max({m.y * n.z + m.z * n.y, m.z * n.x + m.x * n.z, m.x * n.y + m.y * n.x});
}

int side_of_plane(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                  const glm::dvec4& p) {
  const glm::dvec3 e = b - a, f = c - a, q = p.w != 0.0 ? glm::dvec3(p) - a : glm::dvec3(p);
  const double value = glm::dot(glm::cross(e, f), q);
  // Five for the normal, one for q, one for the product and two for the sum; and as many again for
  // what is of second order and for the bound itself.
  const glm::dvec3 size = glm::abs(q);
  const double bound = 18.0 * kRounding * largest_minor(e, f) * (size.x + size.y + size.z);
  if (value > bound) return 1;
  if (value < -bound) return -1;
  if (!std::isfinite(bound)) return 0;
  return exact_side(a, b, c, p);
}

}  // namespace gnomon::pipeline
