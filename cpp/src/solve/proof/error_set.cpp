#include "solve/proof/error_set.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace polhode::proof {
namespace {

constexpr double unit = 0x1p-53;
constexpr double largest_condition = 1e3;   // of a matrix that takes up what steps add
constexpr std::size_t most_parts = 8;

double norm(const std::vector<double>& v) { return std::sqrt(std::inner_product(v.begin(), v.end(), v.begin(), 0.0)); }

}  // namespace

ErrorSet::ErrorSet(const std::vector<double>& radii) : n_(radii.size()) { parts_.push_back(make_box(radii)); }

ErrorSet::Part ErrorSet::make_box(const std::vector<double>& radii) const {
  Part part{std::vector<double>(n_ * n_, 0.0), radii};
  for (std::size_t i = 0; i < n_; ++i) part.basis[i * n_ + i] = 1.0;
  return part;
}

void ErrorSet::add_box(const Part& part, std::vector<double>& sums) const {
  for (std::size_t i = 0; i < n_; ++i)
    for (std::size_t j = 0; j < n_; ++j) sums[i] += std::abs(part.basis[i * n_ + j]) * part.radius[j];
}

std::vector<double> ErrorSet::box() const {
  std::vector<double> sums(n_, 0.0);
  for (const Part& part : parts_) add_box(part, sums);
  for (double& sum : sums) sum = raised(sum);
  return sums;
}

std::vector<double> ErrorSet::multiply(const std::vector<double>& M, int width, const std::vector<double>& B) const {
  const auto w = static_cast<std::size_t>(width);
  std::vector<double> product(n_ * n_, 0.0);
  for (std::size_t i = 0; i < n_; ++i)
    for (std::size_t k = 0; k < n_; ++k) {
      const double factor = M[i * w + k];
      for (std::size_t j = 0; j < n_; ++j) product[i * n_ + j] += factor * B[k * n_ + j];
    }
  return product;
}

std::vector<double> ErrorSet::image_box(const std::vector<double>& M, int width,
                                        const std::vector<double>& slack) const {
  std::vector<double> sums = slack;
  for (const Part& part : parts_) add_box({multiply(M, width, part.basis), part.radius}, sums);
  for (double& sum : sums) sum = raised(sum);
  return sums;
}

void ErrorSet::advance(const std::vector<double>& M, int width, const std::vector<double>& rest) {
  const auto w = static_cast<std::size_t>(width);
  const std::vector<double> outer = box();
  std::vector<double> added(n_);
  for (std::size_t i = 0; i < n_; ++i) {
    double lost = 0.0;   // by rounding in the products M B_j
    for (std::size_t k = 0; k < n_; ++k) lost += std::abs(M[i * w + k]) * outer[k];
    added[i] = raised(rest[i] + (2.0 * static_cast<double>(n_) + 4.0) * unit * lost);
  }
  for (Part& part : parts_) part.basis = multiply(M, width, part.basis);
  if (absorb(added)) return;
  parts_.push_back(make_box(added));
  if (parts_.size() > most_parts) merge_smallest();
}

/// Widens the last part by a box. @return false if its matrix is too skew
bool ErrorSet::absorb(const std::vector<double>& rest) {
  Part& part = parts_.back();
  const std::vector<double> inverse = invert(part.basis, n_);
  if (inverse.empty() || !(norm(part.basis) * norm(inverse) < largest_condition)) return false;
  const double defect = measure_defect(inverse, part.basis, n_);
  if (!(defect < 0.1)) return false;
  std::vector<double> added(n_, 0.0);
  for (std::size_t i = 0; i < n_; ++i)
    for (std::size_t k = 0; k < n_; ++k) added[i] += std::abs(inverse[i * n_ + k]) * rest[k];
  const double wider = raised(widening(defect) * *std::max_element(added.begin(), added.end()));
  for (std::size_t i = 0; i < n_; ++i) part.radius[i] = raised(part.radius[i] + added[i] + wider);
  return true;
}

/// Of all parts but the last, which takes up what comes.
void ErrorSet::merge_smallest() {
  std::vector<double> sizes;
  for (const Part& part : parts_) {
    std::vector<double> sums(n_, 0.0);
    add_box(part, sums);
    sizes.push_back(norm(sums));
  }
  std::vector<std::size_t> order(parts_.size() - 1);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return sizes[a] < sizes[b]; });
  const auto [kept, dropped] = std::minmax(order[0], order[1]);
  parts_[kept] = merge(parts_[kept], parts_[dropped]);
  parts_.erase(parts_.begin() + static_cast<std::ptrdiff_t>(dropped));
}

ErrorSet::Part ErrorSet::merge(const Part& first, const Part& second) const {
  const std::size_t m = 2 * n_;
  std::vector<double> G(n_ * m);   // all vectors G x with |x_i| <= 1
  for (std::size_t i = 0; i < n_; ++i)
    for (std::size_t j = 0; j < n_; ++j) {
      G[i * m + j] = first.basis[i * n_ + j] * first.radius[j];
      G[i * m + n_ + j] = second.basis[i * n_ + j] * second.radius[j];
    }
  const std::vector<double> Q = orthonormalize(G, n_, m);
  std::vector<double> transposed(n_ * n_);
  for (std::size_t i = 0; i < n_; ++i)
    for (std::size_t j = 0; j < n_; ++j) transposed[i * n_ + j] = Q[j * n_ + i];
  const double defect = measure_defect(transposed, Q, n_);
  if (!(defect < 0.5)) {   // no basis was found: a box in fixed axes
    std::vector<double> sums(n_, 0.0);
    add_box(first, sums), add_box(second, sums);
    for (double& sum : sums) sum = raised(sum);
    return make_box(sums);
  }
  const double rounding = (2.0 * static_cast<double>(n_) + 6.0) * unit;
  std::vector<double> radius(n_, 0.0);
  for (std::size_t i = 0; i < n_; ++i)
    for (std::size_t j = 0; j < m; ++j) {
      double entry = 0.0, size = 0.0;
      for (std::size_t k = 0; k < n_; ++k) {
        const double product = transposed[i * n_ + k] * G[k * m + j];
        entry += product, size += std::abs(product);
      }
      radius[i] += std::abs(entry) + rounding * size;
    }
  const double wider = raised(widening(defect) * *std::max_element(radius.begin(), radius.end()));
  for (double& r : radius) r = raised(r + wider);
  return {Q, std::move(radius)};
}

}  // namespace polhode::proof
