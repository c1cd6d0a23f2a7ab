#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "derivative/column_motion.hpp"
#include "derivative/column_samples.hpp"
#include "derivative/column_terms.hpp"
#include "polhode/scene/parameter.hpp"
#include "polhode/derivative/sensitivity.hpp"
#include "solve/ground/pieces.hpp"

namespace polhode {

/// What a run through controllers needs besides.
struct LoopOptions {
  double accuracy;      ///< of the motion, which decides what branch of a law is certain
  std::uint64_t body;   ///< whose number decides the draws
  bool rescale;         ///< multiply columns that leave float64's range by powers of two
};

/// Integrates the columns of a scene through its pieces.
class ColumnRun {
 public:
  /// @param side  of the small rotations of the start
  ColumnRun(const Scene& scene, const std::vector<SceneParameter>& parameters, RotationSide side,
            const LoopOptions& loop);

  /// @param most  compute about so many samples in each direction of time, the last among them; 0: all
  /// @throws IntegrationFailure if it does not reach its end
  ColumnSamples run(double rtol, long max_steps, std::size_t most) const;

 private:
  struct Moment;   ///< a state with its columns

  void follow(const std::vector<Piece>& pieces, const std::vector<std::size_t>& order, double rtol, long max_steps,
              ColumnSamples& out) const;
  /// The same from tick to tick of a scene with controllers.
  void follow_clock(const Piece& piece, const std::vector<std::size_t>& order, double rtol, long max_steps,
                    ColumnSamples& out) const;
  void start_momenta(const SceneParameter& by, const std::function<void(int state, double slope)>& add) const;
  std::vector<double> start_columns() const;
  std::vector<bool> find_rotating(const Piece& piece) const;
  std::vector<ColumnCause> find_causes(const Piece& piece, const std::vector<bool>& rotating) const;
  Matrix3d find_inertia_change(const SceneParameter& parameter) const;
  Vector3d find_momentum_change(const SceneParameter& parameter, const std::vector<bool>& rotating) const;
  std::vector<double> find_state_rates(const Moment& at, const std::vector<AnyTorque>& torques) const;
  Vector3d accelerate(const Moment& at, const std::vector<AnyTorque>& torques, const Vector3d& h) const;
  Vector3d divide(const Vector3d& L_B) const { return J_inverse_ * L_B; }
  /// Carries a state and its columns over a jump of a body that changes.
  void change(const Momentum& before, const Momentum& after, Moment& at) const;
  void cross(const Piece& before, const std::vector<bool>& from, const std::vector<bool>& to, bool forward,
             Moment& at) const;

  const Scene& scene_;
  const std::vector<SceneParameter>& parameters_;
  RotationSide side_;
  LoopOptions loop_;
  Pieces pieces_;
  std::size_t states_;                   ///< numbers of the states of formulas
  Matrix3d J_inverse_;
  std::vector<Vector3d> momenta_;        ///< of each rotor while it rotates, body axes
  std::vector<Matrix3d> inertia_change_; ///< of each parameter
  mutable std::map<const Piece*, ModeEquations> equations_;   ///< of formulas
};

}  // namespace polhode
