#include "derivative/column_terms.hpp"

#include <algorithm>

#include "polhode/core/error.hpp"

namespace polhode {
namespace {

using Source = ForceSource;

/// Collects the terms. Each torque with kernels has three functions: its derivative by the state, by one of its numbers,
/// and by the inertia. The compiler asks for them; all other torques have ColumnEquations.
class TermsBuilder {
 public:
  TermsBuilder(const Matrix3d& R_BP, const Vector3d& J, ColumnTerms& terms)
      : R_BP_(R_BP), R_PB_(R_BP.transpose()), J_(J), terms_(terms) {}

  // -- the derivative by the state ----------------------------------------------------------------------------------
  void add(const torques::Constant& torque) {
    if (torque.frame() == torques::Constant::Frame::space) terms_.space += torque.torque();
  }
  void add(const torques::Gravity& torque) { terms_.moment += R_PB_ * torque.moment(); }
  void add(const torques::Damping& torque) { add_linear(-(R_PB_ * torque.matrix() * R_BP_)); }
  void add(const torques::AngularDamping& torque) { add_linear(-torque.rate() * Matrix3d(J_.asDiagonal())); }
  void add(const torques::GravityGradient& torque) {
    for (int i = 0; i < 3; ++i) terms_.tidal[i] += torque.strength() * (J_[next_axis(next_axis(i))] - J_[next_axis(i)]);
    terms_.orbit_rate = torque.mean_motion();
  }
  template <class Torque>
  void add(const Torque& torque) requires(!torques::HasKernel<Torque>) { refuse(torque.record().name); }

  void add_rotors(const Vector3d& h_B) {   // -d x h
    const Vector3d h = R_PB_ * h_B;
    Matrix3d cross;
    cross << 0, -h[2], h[1], h[2], 0, -h[0], -h[1], h[0], 0;
    add_linear(cross);
  }

  // -- the derivative by a torque's own number ----------------------------------------------------------------------
  void force(int column, const torques::Constant& torque, int, int component) {
    if (torque.frame() == torques::Constant::Frame::body) {
      for (int i = 0; i < 3; ++i) put(column, i, Source::one, 0, R_PB_(i, component));
    } else {
      const Source axes[3] = {Source::space_x, Source::space_y, Source::space_z};
      for (int i = 0; i < 3; ++i) put(column, i, axes[component], i, 1.0);
    }
  }
  void force(int column, const torques::Gravity& torque, int field, int component) {
    const Vector3d moment = R_PB_ * (field == 0 ? torque.arm() : Vector3d(torque.weight() * Vector3d::Unit(component)));
    for (int i = 0; i < 3; ++i) {   // -moment x (vertical)
      const int j = next_axis(i), k = next_axis(j);
      put(column, i, Source::space_z, k, -moment[j]), put(column, i, Source::space_z, j, moment[k]);
    }
  }
  void force(int column, const torques::Damping&, int, int component) {
    for (int i = 0; i < 3; ++i)
      for (int a = 0; a < 3; ++a)
        put(column, i, Source::rates, a, -R_PB_(i, component / 3) * R_BP_(component % 3, a));
  }
  void force(int column, const torques::AngularDamping&, int, int) {
    for (int i = 0; i < 3; ++i) put(column, i, Source::rates, i, -J_[i]);
  }
  void force(int column, const torques::GravityGradient& torque, int field, int) {
    for (int i = 0; i < 3; ++i) {
      const double gap = J_[next_axis(next_axis(i))] - J_[next_axis(i)];
      if (field == 0) put(column, i, Source::radius_pairs, i, 6.0 * torque.mean_motion() * gap);
      put(column, i, field == 0 ? Source::timed_pairs : Source::tangent_pairs, i, torque.strength() * gap);
    }
  }
  template <class Torque>
  void force(int, const Torque& torque, int, int) requires(!torques::HasKernel<Torque>) {
    refuse(torque.record().name);
  }

  // -- the derivative by the inertia --------------------------------------------------------------------------------
  void force_inertia(int column, const Matrix3d& dJ_B) {
    const Matrix3d D = R_PB_ * dJ_B * R_BP_;
    put_cross(column, D, -1.0, Source::rate_squares, Source::rate_pairs);
    put_linear(column, -D, Source::derivatives);
  }
  void force_inertia(int column, const torques::GravityGradient& torque, const Matrix3d& dJ_B) {
    put_cross(column, R_PB_ * dJ_B * R_BP_, torque.strength(), Source::radius_squares, Source::radius_pairs);
  }
  void force_inertia(int column, const torques::AngularDamping& torque, const Matrix3d& dJ_B) {
    put_linear(column, -torque.rate() * (R_PB_ * dJ_B * R_BP_), Source::rates);
  }
  void force_inertia(int, const torques::Constant&, const Matrix3d&) {}
  void force_inertia(int, const torques::Gravity&, const Matrix3d&) {}
  void force_inertia(int, const torques::Damping&, const Matrix3d&) {}
  template <class Torque>
  void force_inertia(int, const Torque& torque, const Matrix3d&) requires(!torques::HasKernel<Torque>) {
    refuse(torque.record().name);
  }

  void force_rotors(int column, const Vector3d& dh_B) {   // dh x w
    const Vector3d h = R_PB_ * dh_B;
    for (int i = 0; i < 3; ++i) {
      const int j = next_axis(i), k = next_axis(j);
      put(column, i, Source::rates, k, h[j]), put(column, i, Source::rates, j, -h[k]);
    }
  }

 private:
  /// Other torques than those with kernels have ColumnEquations.
  [[noreturn]] static void refuse(std::string_view name) {
    throw InvalidInput("sensitivity", "left out for a scene with a torque of the user's own", name,
                       "a function has no formula that could be differentiated");
  }

  void put(int column, int component, Source source, int part, double torque) {
    if (torque != 0.0) terms_.forces.push_back({column, component, source, part, torque / J_[component]});
  }
  void put_linear(int column, const Matrix3d& M, Source source) {
    for (int i = 0; i < 3; ++i)
      for (int a = 0; a < 3; ++a) put(column, i, source, a, M(i, a));
  }
  /// factor v x (D v), from the squares and the products of two components of v
  void put_cross(int column, const Matrix3d& D, double factor, Source squares, Source pairs) {
    for (int i = 0; i < 3; ++i) {
      const int j = next_axis(i), k = next_axis(j);   // v_j (D v)_k - v_k (D v)_j
      put(column, i, squares, j, factor * D(k, j)), put(column, i, squares, k, -factor * D(j, k));
      put(column, i, pairs, i, factor * (D(k, k) - D(j, j)));
      put(column, i, pairs, k, factor * D(k, i)), put(column, i, pairs, j, -factor * D(j, i));
    }
  }
  void add_linear(const Matrix3d& M) {
    for (int i = 0; i < 3; ++i)
      for (int c = 0; c < 3; ++c) terms_.linear[3 * i + c] += M(i, c) / J_[i];
  }

  Matrix3d R_BP_, R_PB_;
  Vector3d J_;
  ColumnTerms& terms_;
};

}  // namespace

bool ColumnTerms::uses(ForceSource source) const {
  return std::any_of(forces.begin(), forces.end(), [&](const Force& force) { return force.source == source; });
}

ColumnTerms make_column_terms(const Scene& piece, const Matrix3d& R_BP, const Vector3d& J,
                              const std::vector<ColumnCause>& causes) {
  ColumnTerms terms;
  for (int i = 0; i < 3; ++i)
    terms.product[i] = (J[next_axis(i)] - J[next_axis(next_axis(i))]) / J[i], terms.inverse[i] = 1.0 / J[i];
  TermsBuilder builder(R_BP, J, terms);
  std::vector<LastingTorque> acting;
  for (const AnyTorque& torque : piece.torques()) acting.push_back(drop_windows(torque));
  for (const LastingTorque& torque : acting) std::visit([&](const auto& one) { builder.add(one); }, torque);
  builder.add_rotors(piece.rotor_momentum());
  for (std::size_t c = 0; c < causes.size(); ++c) {
    const ColumnCause& cause = causes[c];
    const int column = static_cast<int>(c);
    if (!cause.rotor_momentum.isZero(0.0)) builder.force_rotors(column, cause.rotor_momentum);
    if (cause.torque)
      std::visit([&](const auto& one) { builder.force(column, one, cause.field, cause.component); }, *cause.torque);
    if (cause.inertia.isZero(0.0)) continue;
    builder.force_inertia(column, cause.inertia);
    for (const LastingTorque& torque : acting)
      std::visit([&](const auto& one) { builder.force_inertia(column, one, cause.inertia); }, torque);
  }
  const bool tidal = terms.tidal[0] != 0.0 || terms.tidal[1] != 0.0 || terms.tidal[2] != 0.0;
  terms.pulled = tidal || !terms.moment.isZero(0.0) || !terms.space.isZero(0.0);
  return terms;
}

}  // namespace polhode
