#include "ar/pose.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <opencv2/calib3d.hpp>

#include "raster/check.h"

namespace gnomon::ar {
namespace {

constexpr double kHuber_px = 1.0;
/// Minima closer than this are one.
constexpr double kSameRotation_rad = 0.2 * 3.14159265358979323846 / 180.0;
/// A body with more tags starts its fit from its largest ones only.
constexpr std::size_t kMaxSeedTags = 8;
/// Stands for the error of a corner that the pose puts where the lens sees nothing.
constexpr double kUnseen_px = 1e4;

glm::dvec3 apply(const glm::dmat4& m, const glm::dvec3& p) {
  return glm::dvec3(m * glm::dvec4(p, 1.0));
}

double area(const TagCorners& c) {
  const glm::dvec2 a = c[2] - c[0], b = c[3] - c[1];
  return 0.5 * std::abs(a.x * b.y - a.y * b.x);
}

/// Rotation by |w| about w, after `m`'s own, and a shift.
glm::dmat4 moved(const glm::dmat4& m, const glm::dvec3& w, const glm::dvec3& shift) {
  const double angle = glm::length(w);
  glm::dquat q = glm::normalize(glm::quat_cast(glm::dmat3(m)));
  if (angle > 0.0) q = glm::normalize(glm::angleAxis(angle, w / angle) * q);
  glm::dmat4 result = glm::mat4_cast(q);
  result[3] = glm::dvec4(glm::dvec3(m[3]) + shift, 1.0);
  return result;
}

double mean_squared_px(const Lens& lens, const TagView& view, const glm::dmat4& pose) {
  double sum = 0.0;
  for (std::size_t c = 0; c < 4; ++c) {
    const auto pixel = lens.project(apply(pose, view.body_m[c]));
    if (!pixel) return kUnseen_px * kUnseen_px;
    const glm::dvec2 miss = *pixel - view.corners_px[c];
    sum += glm::dot(miss, miss);
  }
  return sum / 4.0;
}

double huber(double squared) {
  return squared <= kHuber_px * kHuber_px ? squared
                                          : kHuber_px * (2.0 * std::sqrt(squared) - kHuber_px);
}

double robust_cost(const Lens& lens, std::span<const TagView> views, const std::vector<bool>& used,
                   const glm::dmat4& pose) {
  double sum = 0.0;
  for (std::size_t v = 0; v < views.size(); ++v) {
    if (!used[v]) continue;
    for (std::size_t c = 0; c < 4; ++c) {
      const auto pixel = lens.project(apply(pose, views[v].body_m[c]));
      const glm::dvec2 miss = pixel ? *pixel - views[v].corners_px[c] : glm::dvec2(kUnseen_px, 0);
      sum += huber(glm::dot(miss, miss));
    }
  }
  return sum;
}

struct NormalEquations {
  cv::Matx66d a = cv::Matx66d::zeros();
  cv::Vec6d b = cv::Vec6d::all(0.0);
};

/// Adds a corner's two rows: derivatives of its pixel by a turn about the camera's axes and a
/// shift.
void add_corner(const Lens& lens, const glm::dmat4& pose, const glm::dvec3& body,
                const glm::dvec2& seen, NormalEquations& equations) {
  const glm::dvec3 p = apply(pose, body);
  const auto pixel = lens.project(p);
  if (!pixel) return;
  const double h = 1e-6 * p.z;
  glm::dvec2 by_point[3];
  for (int k = 0; k < 3; ++k) {
    glm::dvec3 step(0.0);
    step[k] = h;
    const auto ahead = lens.project(p + step), behind = lens.project(p - step);
    if (!ahead || !behind) return;
    by_point[k] = (*ahead - *behind) / (2.0 * h);
  }
  const glm::dvec3 r = p - glm::dvec3(pose[3]);
  const glm::dvec2 miss = seen - *pixel;
  const double squared = glm::dot(miss, miss);
  const double weight = squared <= kHuber_px * kHuber_px ? 1.0 : kHuber_px / std::sqrt(squared);
  for (int axis = 0; axis < 2; ++axis) {
    const glm::dvec3 d{by_point[0][axis], by_point[1][axis], by_point[2][axis]};
    const glm::dvec3 turn = glm::cross(r, d);
    const double row[6] = {turn.x, turn.y, turn.z, d.x, d.y, d.z};
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) equations.a(i, j) += weight * row[i] * row[j];
      equations.b(i) += weight * row[i] * miss[axis];
    }
  }
}

/// Levenberg-Marquardt over all corners of the used views, with Huber weights.
glm::dmat4 fit(const Lens& lens, std::span<const TagView> views, const std::vector<bool>& used,
               glm::dmat4 pose) {
  double cost = robust_cost(lens, views, used, pose);
  double damping = 1e-3;
  for (int iteration = 0; iteration < 50; ++iteration) {
    NormalEquations equations;
    for (std::size_t v = 0; v < views.size(); ++v) {
      for (std::size_t c = 0; used[v] && c < 4; ++c) {
        add_corner(lens, pose, views[v].body_m[c], views[v].corners_px[c], equations);
      }
    }
    bool better = false;
    double change = 0.0;
    for (int attempt = 0; attempt < 8 && !better; ++attempt) {
      cv::Matx66d a = equations.a;
      for (int i = 0; i < 6; ++i) a(i, i) += damping * a(i, i) + 1e-12;
      cv::Vec6d step;
      if (!cv::solve(a, equations.b, step, cv::DECOMP_CHOLESKY)) {
        damping *= 10.0;
        continue;
      }
      const glm::dvec3 shift{step(3), step(4), step(5)};
      const glm::dmat4 next = moved(pose, {step(0), step(1), step(2)}, shift);
      const double next_cost = robust_cost(lens, views, used, next);
      if (next_cost < cost) {
        change = cost - next_cost;
        pose = next;
        cost = next_cost;
        damping = std::max(damping * 0.1, 1e-9);
        better = true;
      } else {
        damping *= 10.0;
      }
    }
    if (!better || change < 1e-10 * (1.0 + cost)) break;
  }
  return pose;
}

glm::dmat4 rigid_from(const cv::Mat& rotation_vector, const cv::Mat& translation) {
  cv::Matx33d r;
  cv::Rodrigues(rotation_vector, r);
  glm::dmat4 m(1.0);
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col < 3; ++col) m[col][row] = r(row, col);
    m[3][row] = translation.at<double>(row);
  }
  return m;
}

bool usable(const glm::dmat4& m) {
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) {
      if (!std::isfinite(m[c][r])) return false;
    }
  }
  return true;
}

/// Body from the tag whose corners these are, and the tag's size.
std::pair<glm::dmat4, double> tag_frame(const TagView& view) {
  const glm::dvec3 right = view.body_m[1] - view.body_m[0];
  const glm::dvec3 up = view.body_m[0] - view.body_m[3];
  const double size = glm::length(right);
  const glm::dvec3 x = right / size, y = up / glm::length(up);
  glm::dmat4 m(1.0);
  m[0] = glm::dvec4(x, 0.0);
  m[1] = glm::dvec4(y, 0.0);
  m[2] = glm::dvec4(glm::cross(x, y), 0.0);
  m[3] =
      glm::dvec4(0.25 * (view.body_m[0] + view.body_m[1] + view.body_m[2] + view.body_m[3]), 1.0);
  return {m, size};
}

/// Both poses of one square, camera from body.
std::vector<glm::dmat4> square_poses(const Lens& lens, const TagView& view) {
  std::vector<cv::Point2d> seen;
  for (const glm::dvec2& corner : view.corners_px) {
    const auto n = lens.undistort(corner);
    if (!n) return {};
    seen.emplace_back(n->x, n->y);
  }
  const auto [body_from_tag, size] = tag_frame(view);
  std::vector<cv::Point3d> model;
  for (const glm::dvec3& p : tag_corners_m(size)) model.emplace_back(p.x, p.y, p.z);
  std::vector<cv::Mat> rotations, translations;
  try {
    cv::solvePnPGeneric(model, seen, cv::Matx33d::eye(), cv::noArray(), rotations, translations,
                        false, cv::SOLVEPNP_IPPE_SQUARE);
  } catch (const cv::Exception&) {
    // Four corners on a line: no pose.
    return {};
  }
  std::vector<glm::dmat4> poses;
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    const glm::dmat4 pose =
        rigid_from(rotations[i], translations[i]) * rigid_inverse(body_from_tag);
    if (usable(pose)) poses.push_back(pose);
  }
  return poses;
}

double rms_of_used(const Lens& lens, std::span<const TagView> views, const PoseFit& fit) {
  double sum = 0.0;
  int count = 0;
  for (std::size_t v = 0; v < views.size(); ++v) {
    if (!fit.used[v]) continue;
    sum += mean_squared_px(lens, views[v], fit.camera_from_body);
    ++count;
  }
  return std::sqrt(sum / std::max(count, 1));
}

double worst_of_used(const Lens& lens, std::span<const TagView> views, const PoseFit& fit) {
  double worst = 0.0;
  for (std::size_t v = 0; v < views.size(); ++v) {
    if (fit.used[v]) worst = std::max(worst, mean_squared_px(lens, views[v], fit.camera_from_body));
  }
  return std::sqrt(worst);
}

/// The best fit without one of the tags used. Every tag is tried, because a wrong one bends the
/// pose and makes others look wrong. Of two tags either explains itself: the one nearer to `start`
/// stays.
PoseFit fit_without_one(const Lens& lens, std::span<const TagView> views, const PoseFit& with,
                        const glm::dmat4& start) {
  PoseFit best;
  double best_score = 0.0;
  const bool pair = std::count(with.used.begin(), with.used.end(), true) == 2;
  for (std::size_t v = 0; v < views.size(); ++v) {
    if (!with.used[v]) continue;
    PoseFit candidate = with;
    candidate.used[v] = false;
    candidate.camera_from_body =
        fit(lens, views, candidate.used, pair ? start : with.camera_from_body);
    const double score =
        pair ? -mean_squared_px(lens, views[v], start) : rms_of_used(lens, views, candidate);
    if (best.used.empty() || score < best_score) {
      best = std::move(candidate);
      best_score = score;
    }
  }
  return best;
}

/// Leaves tags out as long as one disagrees and leaving one out helps much. Where the layout is
/// measured badly all tags disagree a little, and all stay.
PoseFit without_outliers(const Lens& lens, std::span<const TagView> views,
                         const PoseOptions& options, PoseFit result, const glm::dmat4& start) {
  constexpr double kMuchBetter = 0.5;
  for (std::size_t round = 1; round < views.size(); ++round) {
    if (worst_of_used(lens, views, result) <= options.outlier_px) break;
    PoseFit next = fit_without_one(lens, views, result, start);
    if (rms_of_used(lens, views, next) > kMuchBetter * rms_of_used(lens, views, result)) break;
    result = std::move(next);
  }
  return result;
}

bool same_pose(const PoseFit& a, const PoseFit& b) {
  return a.used == b.used &&
         rotation_between_rad(a.camera_from_body, b.camera_from_body) < kSameRotation_rad;
}

void judge(const Lens& lens, std::span<const TagView> views, const PoseOptions& options,
           PoseFit& fit) {
  const double variance = options.corner_noise_px * options.corner_noise_px;
  double sum = 0.0;
  int corners = 0;
  fit.chi2 = 0.0;
  for (std::size_t v = 0; v < views.size(); ++v) {
    if (fit.used[v]) {
      sum += 4.0 * mean_squared_px(lens, views[v], fit.camera_from_body);
      corners += 4;
    } else {
      fit.chi2 += 4.0 * options.outlier_px * options.outlier_px / variance;
    }
  }
  fit.chi2 += sum / variance;
  fit.rms_px = std::sqrt(sum / std::max(corners, 1));
}

}  // namespace

double rotation_between_rad(const glm::dmat4& a, const glm::dmat4& b) {
  const glm::dquat q =
      glm::normalize(glm::quat_cast(glm::transpose(glm::dmat3(a)) * glm::dmat3(b)));
  return 2.0 * std::atan2(std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z), std::abs(q.w));
}

bool is_rotation(const glm::dmat3& m) {
  const glm::dmat3 product = glm::transpose(m) * m;
  for (int c = 0; c < 3; ++c)
    for (int k = 0; k < 3; ++k)
      if (std::abs(product[c][k] - (c == k ? 1.0 : 0.0)) > kRigidTolerance) return false;
  return glm::determinant(m) > 0.0;
}

glm::dmat4 rigid_inverse(const glm::dmat4& m) {
  const glm::dmat3 r = glm::transpose(glm::dmat3(m));
  glm::dmat4 result(r);
  result[3] = glm::dvec4(-(r * glm::dvec3(m[3])), 1.0);
  return result;
}

glm::dmat4 opengl_from_opencv_axes() {
  glm::dmat4 m(1.0);
  m[1][1] = -1.0;
  m[2][2] = -1.0;
  return m;
}

std::vector<PoseFit> body_poses(const Lens& lens, std::span<const TagView> views,
                                const PoseOptions& options,
                                const std::optional<glm::dmat4>& prior) {
  raster::require(options.corner_noise_px > 0.0 && options.outlier_px > 0.0,
                  "noise and outlier limits are positive");
  std::vector<std::size_t> order(views.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return area(views[a].corners_px) > area(views[b].corners_px);
  });
  order.resize(std::min(order.size(), kMaxSeedTags));
  std::vector<glm::dmat4> seeds;
  if (prior && usable(*prior)) seeds.push_back(*prior);
  for (const std::size_t v : order) {
    for (const glm::dmat4& pose : square_poses(lens, views[v])) seeds.push_back(pose);
  }
  std::vector<PoseFit> fits;
  if (order.empty()) return fits;
  std::vector<PoseFit> complete;
  const auto has = [](const std::vector<PoseFit>& all, const PoseFit& one) {
    return std::any_of(all.begin(), all.end(), [&](const PoseFit& f) { return same_pose(f, one); });
  };
  for (const glm::dmat4& seed : seeds) {
    PoseFit candidate;
    candidate.used.assign(views.size(), true);
    candidate.camera_from_body = fit(lens, views, candidate.used, seed);
    // Which of two tags stays depends on the start.
    if (views.size() != 2 && has(complete, candidate)) continue;
    complete.push_back(candidate);
    candidate = without_outliers(lens, views, options, std::move(candidate), seed);
    if (!usable(candidate.camera_from_body)) continue;
    judge(lens, views, options, candidate);
    if (candidate.rms_px >= kUnseen_px) continue;
    if (!has(fits, candidate)) fits.push_back(std::move(candidate));
  }
  std::stable_sort(fits.begin(), fits.end(),
                   [](const PoseFit& a, const PoseFit& b) { return a.chi2 < b.chi2; });
  return fits;
}

std::vector<PoseFit> tag_poses(const Lens& lens, const TagCorners& corners_px, double size_m,
                               const PoseOptions& options) {
  raster::require(size_m > 0.0, "a tag's size is positive");
  const TagView view{tag_corners_m(size_m), corners_px};
  return body_poses(lens, std::span(&view, 1), options);
}

std::size_t PoseChooser::choose(std::span<const PoseFit> fits,
                                const std::optional<glm::dmat4>& prior) {
  raster::require(!fits.empty(), "a pose is chosen from at least one");
  if (!prior || fits.size() == 1) {
    evidence_ = 0.0;
    return 0;
  }
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < fits.size(); ++i) {
    if (rotation_between_rad(fits[i].camera_from_body, *prior) <
        rotation_between_rad(fits[nearest].camera_from_body, *prior)) {
      nearest = i;
    }
  }
  if (nearest == 0) {
    evidence_ = std::max(0.0, evidence_ - (fits[1].chi2 - fits[0].chi2));
    return 0;
  }
  evidence_ += fits[nearest].chi2 - fits[0].chi2;
  if (evidence_ <= threshold_) return nearest;
  evidence_ = 0.0;
  return 0;
}

}  // namespace gnomon::ar
