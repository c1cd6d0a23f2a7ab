#include "solve/proof/error_set.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace polhode::proof {
namespace {

constexpr double unit = 0x1p-53;

/// Makes the columns of G orthonormal, the largest first: the axes of the new set follow its longest edges.
std::vector<double> orthonormalize(const std::vector<double>& G, const std::vector<double>& radius, int n) {
  const auto at = [n](int i, int j) { return static_cast<std::size_t>(i * n + j); };
  std::vector<double> columns(G.size()), length(static_cast<std::size_t>(n));   // columns stored one after the other
  for (int j = 0; j < n; ++j) {
    double sum = 0.0;
    for (int i = 0; i < n; ++i) sum += G[at(i, j)] * G[at(i, j)];
    length[static_cast<std::size_t>(j)] = std::sqrt(sum) * radius[static_cast<std::size_t>(j)];
  }
  std::vector<int> order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return length[static_cast<std::size_t>(a)] > length[static_cast<std::size_t>(b)]; });
  for (int c = 0; c < n; ++c)
    for (int i = 0; i < n; ++i) columns[at(c, i)] = G[at(i, order[static_cast<std::size_t>(c)])];

  const auto dot = [&](int a, int b) {
    double sum = 0.0;
    for (int i = 0; i < n; ++i) sum += columns[at(a, i)] * columns[at(b, i)];
    return sum;
  };
  int unused = 0;   // a unit vector to put in place of a column that depends on the ones before it
  for (int c = 0; c < n; ++c) {
    double before = std::sqrt(dot(c, c));
    for (int pass = 0; pass < 4 * n; ++pass) {
      for (int b = 0; b < c; ++b) {
        const double along = dot(b, c);
        for (int i = 0; i < n; ++i) columns[at(c, i)] -= along * columns[at(b, i)];
      }
      const double after = std::sqrt(dot(c, c));
      if (after > 0.5 * before && after > 1e-280) {
        for (int i = 0; i < n; ++i) columns[at(c, i)] /= after;
        break;
      }
      before = after;
      if (!(after > 1e-280) || pass > 3) {
        for (int i = 0; i < n; ++i) columns[at(c, i)] = i == unused % n ? 1.0 : 0.0;
        ++unused, before = 1.0;
      }
    }
  }
  std::vector<double> Q(G.size());
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) Q[at(i, j)] = columns[at(j, i)];
  return Q;
}

}  // namespace

ErrorSet::ErrorSet(std::vector<double> radii) : n_(static_cast<int>(radii.size())), radius_(std::move(radii)) {
  basis_.assign(static_cast<std::size_t>(n_ * n_), 0.0);
  for (int i = 0; i < n_; ++i) basis_[static_cast<std::size_t>(i * n_ + i)] = 1.0;
}

std::vector<double> ErrorSet::box() const {
  std::vector<double> result(radius_.size());
  for (std::size_t i = 0; i < radius_.size(); ++i) {
    double sum = 0.0;
    for (std::size_t j = 0; j < radius_.size(); ++j) sum += std::abs(basis_[i * radius_.size() + j]) * radius_[j];
    result[i] = raised(sum);
  }
  return result;
}

std::vector<double> ErrorSet::times_basis(const std::vector<double>& M, int width) const {
  const auto n = static_cast<std::size_t>(n_), w = static_cast<std::size_t>(width);
  std::vector<double> product(n * n, 0.0);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t j = 0; j < n; ++j) product[i * n + j] += M[i * w + k] * basis_[k * n + j];
  return product;
}

std::vector<double> ErrorSet::image_box(const std::vector<double>& M, int width,
                                        const std::vector<double>& slack) const {
  const std::vector<double> product = times_basis(M, width);
  std::vector<double> result(radius_.size());
  for (std::size_t i = 0; i < radius_.size(); ++i) {
    double sum = slack[i];
    for (std::size_t j = 0; j < radius_.size(); ++j) sum += std::abs(product[i * radius_.size() + j]) * radius_[j];
    result[i] = raised(sum);
  }
  return result;
}

void ErrorSet::advance(const std::vector<double>& M, int width, const std::vector<double>& rest) {
  const auto n = static_cast<std::size_t>(n_), w = static_cast<std::size_t>(width);
  const std::vector<double> G = times_basis(M, width);
  const std::vector<double> Q = orthonormalize(G, radius_, n_);

  // M e = G x + rounding, in the new basis Q^T (G x + rounding + r): Q^T G is nearly triangular.
  std::vector<double> boxed(n, 0.0), edges(n, 0.0), outer = box();
  for (std::size_t i = 0; i < n; ++i) {
    double lost = 0.0;   // by rounding in M B
    for (std::size_t k = 0; k < n; ++k) lost += std::abs(M[i * w + k]) * outer[k];
    boxed[i] = rest[i] + (2.0 * static_cast<double>(n) + 4.0) * unit * lost;
    for (std::size_t j = 0; j < n; ++j) edges[i] += std::abs(G[i * n + j]) * radius_[j];
  }
  std::vector<double> radius(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    double sum = 0.0;
    for (std::size_t j = 0; j < n; ++j) {
      double entry = 0.0;
      for (std::size_t k = 0; k < n; ++k) entry += Q[k * n + i] * G[k * n + j];
      sum += std::abs(entry) * radius_[j];
    }
    for (std::size_t k = 0; k < n; ++k)
      sum += std::abs(Q[k * n + i]) * (boxed[k] + (2.0 * static_cast<double>(n) + 4.0) * unit * edges[k]);
    radius[i] = raised(sum);
  }

  // Q^-1 = (E - defect)^-1 Q^T with defect = E - Q^T Q: the rows of its size tell how much wider x may be.
  double defect = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    double row = 0.0;
    for (std::size_t j = 0; j < n; ++j) {
      double sum = i == j ? -1.0 : 0.0, size = i == j ? 1.0 : 0.0;
      for (std::size_t k = 0; k < n; ++k) {
        sum += Q[k * n + i] * Q[k * n + j];
        size += std::abs(Q[k * n + i] * Q[k * n + j]);
      }
      row += std::abs(sum) + (2.0 * static_cast<double>(n) + 4.0) * unit * size;
    }
    defect = std::max(defect, raised(row));
  }
  if (!(defect < 0.5)) {   // no basis was found: a box in fixed axes
    const std::vector<double> zero(n, 0.0);
    std::vector<double> wide = image_box(M, width, boxed);
    *this = ErrorSet(std::move(wide));
    return;
  }
  const double widening = raised(defect / (1.0 - defect)) * *std::max_element(radius.begin(), radius.end());
  for (double& r : radius) r = raised(r + widening);
  basis_ = Q;
  radius_ = std::move(radius);
}

}  // namespace polhode::proof
