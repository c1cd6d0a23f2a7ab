#include "polhode/reference/reference.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "polhode/core/error.hpp"
#include "polhode/math/detail/functions.hpp"
#include "reference/law_series.hpp"
#include "solve/ground/formulas.hpp"
#include "solve/ground/pieces.hpp"

namespace polhode {
namespace {

using Real = long double;
using Series = std::vector<Real>;
using Vector = std::array<Series, 3>;

/// Coefficient n of the product of two series.
Real multiply(const Series& a, const Series& b, int n) {
  Real sum = 0;
  for (int j = 0; j <= n; ++j) sum += a[static_cast<std::size_t>(j)] * b[static_cast<std::size_t>(n - j)];
  return sum;
}

Real evaluate(const Series& a, Real s) {
  Real sum = 0;
  for (std::size_t k = a.size(); k-- > 0;) sum = sum * s + a[k];
  return sum;
}

/// x^(1/n) for x > 0, rounded down to 8 bits: steps are the same wherever the coefficients are, to their last bits.
Real find_root(Real x, int n) {
  int exponent = 0;
  const double mantissa = static_cast<double>(std::frexp(x, &exponent));
  const double log = (exponent + math::fast_log2(mantissa)) / n, whole = std::floor(log);
  return std::ldexp(Real(std::floor(256 * math::fast_exp2(log - whole))), static_cast<int>(whole) - 8);
}

/// The Taylor series of a body's motion about one time. Each function here works on coefficient n.
class LongDoubleSeries {
 public:
  LongDoubleSeries(const Scene& scene, int order) : order_(order) {
    for (Vector* v : {&w_, &L_})
      for (Series& s : *v) s.assign(static_cast<std::size_t>(order) + 1, 0);
    for (Series& s : q_) s.assign(static_cast<std::size_t>(order) + 1, 0);
    for (const AnyTorque& torque : scene.torques()) {
      if (std::holds_alternative<torques::Custom>(drop_windows(torque)))
        throw InvalidInput("torques", "without Custom torques, which have no series", "Custom");
      laws_.emplace_back(make_open_law(torque, scene.inertia_B().matrix()), order);
    }
    const Matrix3d& I = scene.inertia_B().matrix();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) I_[i][j] = I(i, j);
    invert();
    for (int i = 0; i < 3; ++i) w_[index(i)][0] = scene.omega()[i], h_[index(i)] = scene.rotor_momentum()[i];
    const Quat& q = scene.attitude();
    const Real parts[4] = {q.x, q.y, q.z, q.w};   // a unit quaternion up to float64 rounding
    const Real size = std::sqrt(parts[0] * parts[0] + parts[1] * parts[1] + parts[2] * parts[2] + parts[3] * parts[3]);
    for (int i = 0; i < 4; ++i) q_[index(i)][0] = parts[i] / size;
  }

  /// Computes all coefficients from those of order 0, at time t.
  void expand(Real t) {
    for (int n = 0; n < order_; ++n) {
      const auto at = index(n), next = index(n + 1);
      for (int i = 0; i < 3; ++i) L_[index(i)][at] = apply(I_, i, w_, n) + (n == 0 ? h_[index(i)] : 0);
      Real tau[3];
      for (int i = 0; i < 3; ++i) {   // L x w
        const auto j = index((i + 1) % 3), k = index((i + 2) % 3);
        tau[i] = multiply(L_[j], w_[k], n) - multiply(L_[k], w_[j], n);
      }
      const Series* const states[7] = {&w_[0], &w_[1], &w_[2], &q_[0], &q_[1], &q_[2], &q_[3]};
      for (LawSeries& law : laws_) {
        Real own[3];
        law.expand(t, n, states, own);
        for (int i = 0; i < 3; ++i) tau[i] += own[i];
      }
      for (int i = 0; i < 3; ++i)
        w_[index(i)][next] = (inverse_[i][0] * tau[0] + inverse_[i][1] * tau[1] + inverse_[i][2] * tau[2]) / (n + 1);
      // q' = q (w, 0) / 2
      const Series &a = w_[0], &b = w_[1], &c = w_[2], &x = q_[0], &y = q_[1], &z = q_[2], &s = q_[3];
      const Real scale = Real(1) / (2 * (n + 1));
      q_[0][next] = scale * (multiply(s, a, n) + multiply(y, c, n) - multiply(z, b, n));
      q_[1][next] = scale * (multiply(s, b, n) + multiply(z, a, n) - multiply(x, c, n));
      q_[2][next] = scale * (multiply(s, c, n) + multiply(x, b, n) - multiply(y, a, n));
      q_[3][next] = -scale * (multiply(x, a, n) + multiply(y, b, n) + multiply(z, c, n));
    }
  }

  /// The step for which the last two terms are `tolerance` of the first, for the rates and for the attitude.
  Real step(Real tolerance, Real longest) const {
    Real h = longest;
    for (int m : {order_ - 1, order_}) {
      Real size = 0, last = 0, angle = 0;
      for (const Series& s : w_) size = std::max(size, std::fabs(s[0])), last = std::max(last, std::fabs(s[index(m)]));
      for (const Series& s : q_) angle = std::max(angle, std::fabs(s[index(m)]));
      if (last > 0 && size > 0) h = std::min(h, find_root(tolerance * size / last, m));
      if (angle > 0) h = std::min(h, find_root(tolerance / angle, m));
    }
    return h;
  }

  void state(Real s, Real* y) const {
    for (int i = 0; i < 3; ++i) y[i] = evaluate(w_[index(i)], s);
    for (int i = 0; i < 4; ++i) y[3 + i] = evaluate(q_[index(i)], s);
  }
  /// Changes the rates of a state where the momentum of the rotors jumps from that of this body: J w + h is continuous.
  void jump(const Vector3d& h, Real* y) const {
    const Real dh[3] = {h[0] - h_[0], h[1] - h_[1], h[2] - h_[2]};
    for (std::size_t i = 0; i < 3; ++i)
      y[i] -= inverse_[i][0] * dh[0] + inverse_[i][1] * dh[1] + inverse_[i][2] * dh[2];
  }
  void restart(const Real* y) {
    for (int i = 0; i < 3; ++i) w_[index(i)][0] = y[i];
    for (int i = 0; i < 4; ++i) q_[index(i)][0] = y[3 + i];
  }

 private:
  using Square = std::array<std::array<Real, 3>, 3>;

  static std::size_t index(int i) { return static_cast<std::size_t>(i); }

  static Real apply(const Square& M, int i, const Vector& v, int n) {
    const auto& row = M[index(i)];
    return row[0] * v[0][index(n)] + row[1] * v[1][index(n)] + row[2] * v[2][index(n)];
  }

  void invert() {
    const auto cofactor = [&](int i, int j) {   // the matrix is symmetric
      const auto a = index((i + 1) % 3), b = index((i + 2) % 3), c = index((j + 1) % 3), d = index((j + 2) % 3);
      return I_[a][c] * I_[b][d] - I_[a][d] * I_[b][c];
    };
    const Real det = I_[0][0] * cofactor(0, 0) + I_[0][1] * cofactor(0, 1) + I_[0][2] * cofactor(0, 2);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) inverse_[index(i)][index(j)] = cofactor(j, i) / det;
  }

  int order_;
  Square I_{}, inverse_{};
  std::array<Real, 3> h_{};     // of the rotors
  Vector w_, L_;
  std::array<Series, 4> q_;
  std::vector<LawSeries> laws_;   // of the torques
};

/// The angular momentum in the body over the rates, H = J w + h, in a piece of a body that changes.
struct RealMomentum {
  Real J[3][3], h[3];

  RealMomentum(const Scene& scene, const BodyPiece& body, const Vector3d& rotors, Real t) {
    const Matrix3d given = scene.given_inertia_B().matrix();
    for (int i = 0; i < 3; ++i) {
      const auto row = static_cast<std::size_t>(i);
      h[i] = rotors[i] + (body.momentum ? Changing::compute_number(*body.momentum, row, t) : 0);
      for (int j = 0; j < 3; ++j) {
        const std::size_t column = static_cast<std::size_t>(j), most = std::max(row, column), least = std::min(row, column);
        Real entry = given(i, j);
        if (body.inertia && body.inertia->terms.front().size() == 9)
          entry = (Changing::compute_number(*body.inertia, 3 * most + least, t) +
                   Changing::compute_number(*body.inertia, 3 * least + most, t)) / 2;
        else if (body.inertia)
          entry = i == j ? Changing::compute_number(*body.inertia, row, t) : 0;
        J[i][j] = entry - scene.inertia_reduction()(i, j);
      }
    }
  }

  /// Rates that become those after a jump from this to another.
  void jump(const RealMomentum& after, bool leaving, Real* w) const {
    Real v[3], determinant = 0, cofactor[3][3];
    for (int i = 0; i < 3; ++i) {
      const Real (&M)[3][3] = leaving ? after.J : J;
      v[i] = h[i] - after.h[i] + M[i][0] * w[0] + M[i][1] * w[1] + M[i][2] * w[2];
    }
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const int a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
        cofactor[i][j] = after.J[a][c] * after.J[b][d] - after.J[a][d] * after.J[b][c];
      }
    for (int i = 0; i < 3; ++i) determinant += after.J[0][i] * cofactor[0][i];
    for (int i = 0; i < 3; ++i)
      w[i] = (cofactor[i][0] * v[0] + cofactor[i][1] * v[1] + cofactor[i][2] * v[2]) / determinant;
  }
};

/// Integrates from t0 through the times in the order of `visit`, all on one side of t0. Continues with the next piece
/// at each end of a window.
void follow(const Scene& scene, const ReferenceOptions& options, const std::vector<Piece>& pieces,
            const std::vector<std::size_t>& visit, Reference& found) {
  if (visit.empty()) return;
  std::vector<Scene> scenes;
  for (const Piece& piece : pieces) {
    scenes.push_back(
        make_piece_scene(scene, piece, {piece.begin, scene.omega(), scene.attitude()}, {piece.end}, scene.want()));
  }
  std::size_t at = 0;
  LongDoubleSeries body(scene, options.order);
  const auto find_body = [&](std::size_t piece, Real t) {
    const double middle = 0.5 * (pieces[piece].begin + pieces[piece].end);
    return RealMomentum(scene, pieces[piece].body, scene.rotor_momentum(middle), t);
  };
  const auto find_later = [&](double t) {
    return RealMomentum(scene, scene.find_body_piece(t), scene.rotor_momentum(t), t);
  };
  const auto enter_piece = [&](Real* y) {
    const double t = pieces[at].begin;
    if (!scene.changes()) body.jump(scenes[at].rotor_momentum(), y);
    else (at == 0 ? find_later(t) : find_body(at - 1, t)).jump(find_body(at, t), scene.leaving(), y);
    body = LongDoubleSeries(scenes[at], options.order);
    body.restart(y);
  };
  Real start[7];
  body.state(0, start);
  enter_piece(start);
  Real t = scene.t0();
  std::size_t next = 0;
  for (long steps = 0; next < visit.size(); ++steps) {
    if (steps == options.max_steps || (steps % 256 == 255 && options.go_on && !options.go_on())) {
      throw IntegrationFailure(static_cast<double>(t), "reference: more than " + std::to_string(steps) + " steps");
    }
    body.expand(t);
    const Real left = Real(pieces[at].end) - t;
    const Real size = body.step(options.tolerance, std::fabs(left)), h = left < 0 ? -size : size;
    for (; next < visit.size(); ++next) {
      const Real s = Real(scene.times()[visit[next]]) - t;
      if (std::fabs(s) > size) break;
      Real y[7];
      body.state(s, y);
      const double when = scene.times()[visit[next]];
      if (when == pieces[at].end && !scene.changes()) body.jump(scene.rotor_momentum(when), y);
      if (when == pieces[at].end && scene.changes())
        find_body(at, when).jump(find_later(when), scene.leaving(), y);
      for (std::size_t i = 0; i < 3; ++i) found.omega[3 * visit[next] + i] = static_cast<double>(y[i]);
      for (std::size_t i = 0; i < 4; ++i) found.attitude[4 * visit[next] + i] = static_cast<double>(y[3 + i]);
    }
    Real y[7];
    body.state(h, y);
    body.restart(y);
    t += h;
    ++found.steps;
    if (std::fabs(left) <= size && at + 1 < pieces.size()) {
      ++at;
      enter_piece(y);
      t = Real(pieces[at].begin);
    }
  }
}

}  // namespace

Reference compute_reference(const Scene& given, const ReferenceOptions& options) {
  const Scene scene = resolve_formulas(given, AsCustom::no);
  const std::vector<double>& times = scene.times();
  Reference found{std::vector<double>(3 * times.size()), std::vector<double>(4 * times.size()), 0};
  std::vector<std::size_t> order(times.size()), after, before;
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return times[a] < times[b]; });
  for (std::size_t i : order) (times[i] < scene.t0() ? before : after).push_back(i);
  std::reverse(before.begin(), before.end());
  const Pieces pieces = cut(scene);
  follow(scene, options, pieces.forward, after, found);
  follow(scene, options, pieces.backward, before, found);
  return found;
}

}  // namespace polhode
