#include "solve/proof/basis.hpp"

#include <algorithm>
#include <cmath>

namespace polhode::proof {
namespace {

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

void subtract(double factor, const std::vector<double>& b, std::vector<double>& a) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= factor * b[i];
}

/// Makes a vector orthogonal to all in a list, and a unit one. Two passes leave only rounding.
/// @return false if little of it is left
bool make_orthonormal(const std::vector<std::vector<double>>& list, std::vector<double>& vector) {
  double left = 1.0;
  for (int pass = 0; pass < 2; ++pass) {
    for (const std::vector<double>& other : list) subtract(dot(other, vector), other, vector);
    const double size = std::sqrt(dot(vector, vector));
    left *= size;
    if (!(left > 1e-6)) return false;
    for (double& x : vector) x /= size;
  }
  return true;
}

}  // namespace

double exp_above(double x) {
  double sum = 1.0, term = 1.0;
  for (int k = 1; k <= 200; ++k) {
    term *= x / k;
    sum += term;
  }
  return raised(sum * (1.0 + 0x1p-40));   // what is left out: 60^200 / 200! is far below a part in 2^40
}

std::vector<double> invert(std::vector<double> A, std::size_t n) {
  std::vector<double> V(n * n, 0.0);
  for (std::size_t i = 0; i < n; ++i) V[i * n + i] = 1.0;
  for (std::size_t c = 0; c < n; ++c) {
    std::size_t pivot = c;
    for (std::size_t i = c + 1; i < n; ++i)
      if (std::abs(A[i * n + c]) > std::abs(A[pivot * n + c])) pivot = i;
    if (!(std::abs(A[pivot * n + c]) > 1e-200)) return {};
    for (std::size_t j = 0; j < n && pivot != c; ++j) {
      std::swap(A[pivot * n + j], A[c * n + j]);
      std::swap(V[pivot * n + j], V[c * n + j]);
    }
    const double scale = 1.0 / A[c * n + c];
    for (std::size_t j = 0; j < n; ++j) A[c * n + j] *= scale, V[c * n + j] *= scale;
    for (std::size_t i = 0; i < n; ++i) {
      const double factor = A[i * n + c];
      if (i == c || factor == 0.0) continue;
      for (std::size_t j = 0; j < n; ++j) {
        A[i * n + j] -= factor * A[c * n + j];
        V[i * n + j] -= factor * V[c * n + j];
      }
    }
  }
  return V;
}

std::vector<double> orthonormalize(const std::vector<double>& G, std::size_t n, std::size_t m) {
  std::vector<std::vector<double>> columns(m, std::vector<double>(n)), chosen;
  for (std::size_t j = 0; j < m; ++j)
    for (std::size_t i = 0; i < n; ++i) columns[j][i] = G[i * m + j];
  // The columns, then the axes in turn for what they do not span.
  for (std::size_t axis = 0; chosen.size() < n && axis < n;) {
    const auto longest = std::max_element(columns.begin(), columns.end(), [](const auto& a, const auto& b) {
      return dot(a, a) < dot(b, b);
    });
    const double length = std::sqrt(dot(*longest, *longest));
    std::vector<double> next(n, 0.0);
    if (length > 1e-150) {
      for (std::size_t i = 0; i < n; ++i) next[i] = (*longest)[i] / length;
      std::fill(longest->begin(), longest->end(), 0.0);
    } else {
      next[axis++] = 1.0;
    }
    if (!make_orthonormal(chosen, next)) continue;
    for (std::vector<double>& column : columns) subtract(dot(next, column), next, column);
    chosen.push_back(std::move(next));
  }
  std::vector<double> Q(n * n, 0.0);
  for (std::size_t j = 0; j < chosen.size(); ++j)
    for (std::size_t i = 0; i < n; ++i) Q[i * n + j] = chosen[j][i];
  return Q;
}

double measure_defect(const std::vector<double>& A, const std::vector<double>& B, std::size_t n) {
  const double rounding = (2.0 * static_cast<double>(n) + 4.0) * 0x1p-53;
  double defect = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    double row = 0.0;
    for (std::size_t j = 0; j < n; ++j) {
      double sum = i == j ? -1.0 : 0.0, size = i == j ? 1.0 : 0.0;
      for (std::size_t k = 0; k < n; ++k) {
        const double product = A[i * n + k] * B[k * n + j];
        sum += product, size += std::abs(product);
      }
      row += std::abs(sum) + rounding * size;
    }
    row = raised(row);
    if (!(row <= defect)) defect = row;   // NaN, too
  }
  return defect;
}

}  // namespace polhode::proof
