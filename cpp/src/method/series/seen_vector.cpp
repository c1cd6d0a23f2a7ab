#include "method/series/seen_vector.hpp"

#include "exact/expansion.hpp"

namespace polhode {
namespace {

using math::DD;

/// a b + ..., exactly until it is read.
class ExactSum {
 public:
  ExactSum& add(double a, double b) {
    const DD product = math::two_prod(a, b);
    sum_.add(product.lo), sum_.add(product.hi);
    return *this;
  }
  DD read() const {
    DD all(0.0);
    for (int i = 0; i < sum_.size; ++i) all = math::two_sum(sum_.term[i], all.hi) + DD(all.lo);
    return all;
  }

 private:
  exact::Expansion sum_;
};

}  // namespace

std::array<DD, 3> see_from_body(const Quat& q, const Vector3d& v_W) {
  const double x = q.x, y = q.y, z = q.z, w = q.w;
  const auto square = [&](double sx, double sy, double sz) {   // w^2 and the others with their signs
    return ExactSum().add(w, w).add(sx * x, x).add(sy * y, y).add(sz * z, z).read();
  };
  const auto twice = [](double a, double b, double c, double d) {
    return math::twice(ExactSum().add(a, b).add(c, d).read());
  };
  const DD R_WB[3][3] = {{square(1, -1, -1), twice(x, y, -w, z), twice(x, z, w, y)},
                         {twice(x, y, w, z), square(-1, 1, -1), twice(y, z, -w, x)},
                         {twice(x, z, -w, y), twice(y, z, w, x), square(-1, -1, 1)}};
  const DD size = square(1, 1, 1);
  std::array<DD, 3> seen;
  for (int i = 0; i < 3; ++i) {
    DD sum(0.0);
    for (int j = 0; j < 3; ++j) sum = sum + R_WB[j][i] * DD(v_W[j]);
    seen[static_cast<std::size_t>(i)] = sum / size;
  }
  return seen;
}

Quat multiply_exactly(const Quat& p, const Quat& q) {
  const auto sum = [](double a, double b, double c, double d, double e, double f, double g, double h) {
    return ExactSum().add(a, b).add(c, d).add(e, f).add(g, h).read().hi;
  };
  return {sum(p.w, q.x, p.x, q.w, p.y, q.z, -p.z, q.y), sum(p.w, q.y, -p.x, q.z, p.y, q.w, p.z, q.x),
          sum(p.w, q.z, p.x, q.y, -p.y, q.x, p.z, q.w), sum(p.w, q.w, -p.x, q.x, -p.y, q.y, -p.z, q.z)};
}

}  // namespace polhode
