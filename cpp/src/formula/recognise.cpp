#include "polhode/formula/recognise.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "formula/polynomial.hpp"
#include "polhode/core/error.hpp"
#include "polhode/formula/trace.hpp"

namespace polhode::formula {
namespace {

using Kind = KnownTorque::Kind;

Monomial pair(std::size_t i, std::size_t j) {
  Monomial m{};
  m[3 + i] = static_cast<std::uint8_t>(m[3 + i] + 1), m[3 + j] = static_cast<std::uint8_t>(m[3 + j] + 1);
  return m;
}

/// The part of a polynomial that has degree 0 or 2 in q, and nothing else: constant + sum of entries_ij R_ij.
struct Rotated {
  double constant = 0.0;
  Matrix3d entries = Matrix3d::Zero();
};

/// From x^2 = (1 + R_00 - R_11 - R_22) / 4, x y = (R_01 + R_10) / 4, z w = (R_10 - R_01) / 4, and so on.
Rotated find_rotated(const Polynomial& p) {
  Rotated found;
  double square[3];
  for (std::size_t i = 0; i < 3; ++i) square[i] = p.coefficient(pair(i, i));
  found.constant = p.coefficient(Monomial{}) + 0.25 * (square[0] + square[1] + square[2]);
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const auto at = [](int n) { return static_cast<std::size_t>(n); };
    found.entries(i, i) = 0.25 * (square[i] - square[j] - square[k]);
    // i, j, k cyclic: R_ji = 2 (q_i q_j + q_k w)
    const double mixed = p.coefficient(pair(at(i), at(j))), scalar = p.coefficient(pair(at(k), 3));
    found.entries(i, j) = 0.25 * (mixed - scalar), found.entries(j, i) = 0.25 * (mixed + scalar);
  }
  return found;
}

/// Numbers that differ by rounding alone, relative to a size.
bool is_close(double a, double b, double size) { return std::abs(a - b) <= 0x1p-49 * size; }

Program make_program(const KnownTorque& known, const Matrix3d& I) {
  return trace([&](const auto& in) {
    const auto vector = [](const Vector3d& v) { return Vec<Expr, 3>{{v[0], v[1], v[2]}}; };
    switch (known.kind) {
      case Kind::constant_in_body: return vector(known.vector);
      case Kind::constant_in_space: return to_body(in.attitude, vector(known.vector));
      case Kind::damping: return -apply_matrix(known.matrix, in.omega);
      case Kind::angular_damping: return -apply_matrix(Matrix3d(known.rate * I), in.omega);
      case Kind::rotors: return cross(vector(known.vector), in.omega);
      case Kind::gravity: return -cross(vector(known.vector), to_body(in.attitude, vector({0, 0, 1})));
      default: {
        const Expr angle = in.t * known.rate + known.phase;
        const Vec<Expr, 3> u = to_body(in.attitude, Vec<Expr, 3>{{cos(angle), sin(angle), 0.0}});
        return cross(u, apply_matrix(I, u)) * Expr(3 * known.rate * known.rate);
      }
    }
  });
}

void find_in_rates(const std::array<Polynomial, 3>& tau, const Matrix3d& I, std::vector<KnownTorque>& parts) {
  Matrix3d A;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      Monomial m{};
      m[static_cast<std::size_t>(j)] = 1;
      A(i, j) = tau[static_cast<std::size_t>(i)].coefficient(m);
    }
  }
  if (A.isZero(0.0)) return;
  const double size = A.cwiseAbs().maxCoeff();
  if (is_close((A + A.transpose()).cwiseAbs().maxCoeff(), 0.0, size)) {
    parts.push_back({.kind = Kind::rotors, .vector = {A(2, 1), A(0, 2), A(1, 0)}});
    return;
  }
  const double rate = -A.trace() / I.trace();
  if (is_close((A + rate * I).cwiseAbs().maxCoeff(), 0.0, size)) {
    parts.push_back({.kind = Kind::angular_damping, .rate = rate});
  } else {
    parts.push_back({.kind = Kind::damping, .matrix = -A});
  }
}

void find_in_attitude(const std::array<Polynomial, 3>& tau, std::vector<KnownTorque>& parts) {
  Rotated rotated[3];
  for (int k = 0; k < 3; ++k) rotated[k] = find_rotated(tau[static_cast<std::size_t>(k)]);
  const Vector3d constant(rotated[0].constant, rotated[1].constant, rotated[2].constant);
  // tau_k = A_kj R_2j is -m x R^T e_z where A is skew; v_i R_ik is R^T v.
  const auto A = [&](int i, int k, int j) { return rotated[k].entries(i, j); };
  const Vector3d moment(0.5 * (A(2, 1, 2) - A(2, 2, 1)), 0.5 * (A(2, 2, 0) - A(2, 0, 2)),
                        0.5 * (A(2, 0, 1) - A(2, 1, 0)));
  Vector3d space;
  for (int i = 0; i < 3; ++i) space[i] = (A(i, 0, 0) + A(i, 1, 1) + A(i, 2, 2)) / 3;
  double size = constant.cwiseAbs().maxCoeff();
  for (const Rotated& each : rotated) size = std::max(size, each.entries.cwiseAbs().maxCoeff());
  const auto is_there = [&](const Vector3d& v) { return !is_close(v.cwiseAbs().maxCoeff(), 0.0, size); };
  if (is_there(constant)) parts.push_back({.kind = Kind::constant_in_body, .vector = constant});
  if (is_there(space)) parts.push_back({.kind = Kind::constant_in_space, .vector = space});
  if (is_there(moment)) parts.push_back({.kind = Kind::gravity, .vector = moment});
}

void subtract(const KnownTorque& known, const Matrix3d& I, std::array<Polynomial, 3>& tau) {
  const TorquePolynomials polynomials = expand_torque(make_program(known, I));
  for (std::size_t i = 0; i < 3; ++i) tau[i].add(polynomials.tau[i], -1.0);
}

std::size_t count_terms(const std::array<Polynomial, 3>& tau) {
  std::size_t count = 0;
  for (const Polynomial& p : tau)
    count += static_cast<std::size_t>(
        std::count_if(p.terms().begin(), p.terms().end(), [](const auto& term) { return !term.second.is_zero(); }));
  return count;
}

}  // namespace

Recognition recognise(const Program& torque, const Matrix3d& inertia_B) {
  if (!torque.parameters.empty()) throw InvalidInput("formula", "bound parameters", "free ones");
  Recognition found;
  TorquePolynomials expanded = expand_torque(torque);
  std::array<Polynomial, 3>& rest = expanded.tau;
  std::vector<KnownTorque> candidates;
  if (const std::optional<Wave>& wave = expanded.wave)
    candidates.push_back({.kind = Kind::gravity_gradient, .rate = wave->rate, .phase = wave->phase});
  // Together, because torques in space share terms, and one of them alone may leave as many as there were.
  const auto take = [&] {
    std::array<Polynomial, 3> less = rest;
    for (const KnownTorque& candidate : candidates) subtract(candidate, inertia_B, less);
    if (count_terms(less) < count_terms(rest)) {
      rest = less;
      found.parts.insert(found.parts.end(), candidates.begin(), candidates.end());
    }
    candidates.clear();
  };
  // A gradient first: it has parts of degree 0 and 2 in q, which are no torques of their own.
  take();
  find_in_rates(rest, inertia_B, candidates);
  take();
  find_in_attitude(rest, candidates);
  take();
  found.is_whole = count_terms(rest) == 0;
  for (std::size_t i = 0; i < 3; ++i) found.is_whole = found.is_whole && expanded.rest.outputs[i].is_zero();
  if (found.parts.empty() && !found.is_whole) {
    found.rest = torque;
  } else {
    found.rest = add_polynomials(std::move(expanded.rest), rest, expanded.wave);
  }
  return found;
}

}  // namespace polhode::formula
