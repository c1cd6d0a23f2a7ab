#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <vector>

#include "polhode/ode/tableaus/dormand_prince54.hpp"
#include "polhode/ode/tableaus/dormand_prince853.hpp"

using namespace polhode::ode::tableaus;

namespace {

/// The order conditions over all rooted trees: sum_i b_i Phi_i(tree) = 1/gamma(tree). Butcher 1963; Hairer, Norsett &
/// Wanner 1993, Solving ODEs I, sec. II.2. A tree is its branches; its Phi is the product of A Phi over them.
template <class T>
class Conditions {
 public:
  static constexpr std::size_t n = T::all_stages;
  using Vector = std::array<double, n>;
  struct Tree {
    double gamma;
    Vector phi;
  };

  explicit Conditions(int most) : by_order_(static_cast<std::size_t>(most) + 1) {
    Vector one;
    one.fill(1.0);
    by_order_[1] = {{1.0, one}};
    for (int order = 2; order <= most; ++order) {
      if (order > 2) grow();
      add(order, order - 1, 0, one, 1.0);
    }
  }

  const std::vector<Tree>& trees(int order) const { return by_order_[static_cast<std::size_t>(order)]; }

  /// The largest residual at the fraction s of a step, over the trees of one order.
  double worst(const Vector& b, int order, double s = 1.0) const {
    double largest = 0.0;
    for (const Tree& tree : trees(order)) {
      double sum = 0.0;
      for (std::size_t i = 0; i < n; ++i) sum += b[i] * tree.phi[i];
      largest = std::fmax(largest, std::abs(sum - std::pow(s, order) / tree.gamma));
    }
    return largest;
  }
  double worst_up_to(const Vector& b, int order, double s = 1.0) const {
    double largest = 0.0;
    for (int k = 1; k <= order; ++k) largest = std::fmax(largest, worst(b, k, s));
    return largest;
  }

 private:
  struct Branch {
    int order;
    double gamma;
    Vector phi;   // A Phi
  };

  void grow() {   // the trees of the last order, as branches
    for (int order = branches_.empty() ? 1 : branches_.back().order + 1;
         static_cast<std::size_t>(order) < by_order_.size() && !by_order_[static_cast<std::size_t>(order)].empty();
         ++order) {
      for (const Tree& tree : trees(order)) branches_.push_back({order, tree.gamma, apply(tree.phi)});
    }
  }

  /// All multisets of branches, in the order of the list, that have `left` vertices together.
  void add(int order, int left, std::size_t from, const Vector& phi, double gamma) {
    if (branches_.empty()) grow();
    if (left == 0) {
      by_order_[static_cast<std::size_t>(order)].push_back({gamma * order, phi});
      return;
    }
    for (std::size_t k = from; k < branches_.size(); ++k) {
      const Branch branch = branches_[k];
      if (branch.order > left) break;
      Vector product;
      for (std::size_t i = 0; i < n; ++i) product[i] = phi[i] * branch.phi[i];
      add(order, left - branch.order, k, product, gamma * branch.gamma);
    }
  }

  static Vector apply(const Vector& v) {
    Vector out{};
    for (std::size_t i = 1; i < n; ++i)
      for (std::size_t j = 0; j < i; ++j) out[i] += T::a[i][j] * v[j];
    return out;
  }

  std::vector<std::vector<Tree>> by_order_;
  std::vector<Branch> branches_;
};

template <class T>
constexpr int lower_order = 4;
template <>
constexpr int lower_order<DormandPrince853> = 5;
template <class T>
constexpr int dense_order = 4;
template <>
constexpr int dense_order<DormandPrince853> = 7;

template <class T>
typename Conditions<T>::Vector weights() {
  typename Conditions<T>::Vector b{};
  for (std::size_t i = 0; i + 1 < T::stages; ++i) b[i] = T::a[T::stages - 1][i];
  return b;
}

}  // namespace

TEST_CASE("rooted trees are counted as they are known to be") {
  const Conditions<DormandPrince54> conditions(8);
  const std::size_t known[] = {0, 1, 1, 2, 4, 9, 20, 48, 115};   // OEIS A000081
  for (int order = 1; order <= 8; ++order) CHECK(conditions.trees(order).size() == known[order]);
}

TEST_CASE_TEMPLATE("a tableau meets its order conditions, its lower formulas only their own", T, DormandPrince54,
                   DormandPrince853) {
  const Conditions<T> conditions(T::order + 1);
  const auto b = weights<T>();
  for (int i = 0; i < T::all_stages; ++i) {
    double row = 0.0, size = 0.0;
    for (int j = 0; j < i; ++j) row += T::a[i][j], size += std::abs(T::a[i][j]);
    CHECK(std::abs(row - T::c[i]) < 1e-15 * (1 + size));
  }
  const double rounding = T::order > 5 ? 2e-14 : 1e-15;   // entries up to 43
  CHECK(conditions.worst_up_to(b, T::order) < rounding);
  CHECK(conditions.worst(b, T::order + 1) > 1e-7);

  auto lower = b;
  for (std::size_t i = 0; i < T::stages; ++i) lower[i] -= T::error[i];
  CHECK(conditions.worst_up_to(lower, lower_order<T>) < rounding);
  CHECK(conditions.worst(lower, lower_order<T> + 1) > 1e-5);
  if constexpr (requires { T::error_low; }) {
    auto lowest = b;
    for (std::size_t i = 0; i < T::stages; ++i) lowest[i] -= T::error_low[i];
    CHECK(conditions.worst_up_to(lowest, 3) < rounding);
    CHECK(conditions.worst(lowest, 4) > 1e-5);
  }
}

TEST_CASE_TEMPLATE("a continuous extension meets the conditions of its order anywhere within a step", T,
                   DormandPrince54, DormandPrince853) {
  const Conditions<T> conditions(dense_order<T> + 1);
  const auto b = weights<T>();
  for (const double s : {0.1, 0.37, 0.5, 0.82, 1.0}) {
    typename Conditions<T>::Vector at{};
    for (std::size_t i = 0; i < T::all_stages; ++i) {
      // s (c1 + r (c2 + s (c3 + r (...)))) as the stepper nests it, of the unit vector of stage i
      const double first = i == 0, last = i == T::stages - 1, c2 = first - b[i];
      double value = 0.0;
      for (int row = T::dense_rows; row-- > 0;) value = (row % 2 == 0 ? 1 - s : s) * (T::dense[row][i] + value);
      value = s * (b[i] - last - c2 + value);
      at[i] = s * (b[i] + (1 - s) * (c2 + value));
    }
    CHECK(conditions.worst_up_to(at, dense_order<T>, s) < 5e-13);
    if (s < 1.0) CHECK(conditions.worst(at, dense_order<T> + 1, s) > 1e-9);
  }
}
