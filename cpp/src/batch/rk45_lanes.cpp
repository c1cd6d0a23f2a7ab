#include <algorithm>
#include <optional>
#include <variant>
#include <vector>

#include "core/choose_level.hpp"
#include "batch/lane_method.hpp"
#include "batch/lanes/rk45_block.hpp"
#include "polhode/core/simd.hpp"
#include "polhode/method/euler_problem.hpp"
#include "polhode/ode/detail/first_step.hpp"
#include "polhode/ode/rk45.hpp"
#include "polhode/ode/detail/step_control.hpp"

namespace polhode {
namespace {

using Row = LaneState::Row;

Rk45Kernels find_kernels(bool diagonal, bool attitude) {
  return choose_level(simd_level(), baseline_rk45_lanes, avx2_rk45_lanes, avx512_rk45_lanes, diagonal, attitude);
}

void put(Row* rows, int lane, const double* values, int n) {
  for (int i = 0; i < n; ++i) rows[i][lane] = values[i];
}

/// The kind of a torque of a scene, and its numbers if `values` is given; nothing for a torque that lanes do not have.
std::optional<LaneTorque::Kind> describe(const Scene& scene, const AnyTorque& torque, double* values = nullptr) {
  using Kind = LaneTorque::Kind;
  using Known = formula::KnownTorque::Kind;
  const auto give = [values](const double* numbers, int n) {
    if (values != nullptr) std::copy_n(numbers, n, values);
  };
  const std::optional<formula::KnownTorque> known = find_known(torque);
  if (!known) return std::nullopt;
  if (const auto C_B = find_damping(torque, scene.inertia_B().matrix())) {
    give(C_B->data(), 9);
    return Kind::damping;
  }
  if (known->kind == Known::gravity_gradient) {
    const double numbers[3] = {known->rate, known->phase, 3 * known->rate * known->rate};
    give(numbers, 3);
    return Kind::gradient;
  }
  give(known->vector.data(), 3);
  switch (known->kind) {
    case Known::constant_in_body: return Kind::body_constant;
    case Known::constant_in_space: return Kind::space_constant;
    case Known::gravity: return Kind::weight;
    case Known::rotors: return Kind::rotors;
    default: return std::nullopt;
  }
}

/// Euler's equations, in the form of run_euler().
class EulerLaneProblem final : public LaneProblem {
 public:
  explicit EulerLaneProblem(const Scene& scene)
      : scene_(scene),
        diagonal_(scene.inertia_B().is_diagonal()),
        attitude_(scene.want().attitude || scene.torque_sum().uses_attitude) {}

  const Scene& scene() const { return scene_; }
  bool diagonal() const { return diagonal_; }
  bool attitude() const { return attitude_; }
  bool rotors() const { return !scene_.rotor_momentum().isZero(0.0); }

  std::string kind() const override {
    std::string kind = {static_cast<char>(diagonal_), static_cast<char>(attitude_)};
    for (const AnyTorque& torque : scene_.torques()) kind += static_cast<char>(*describe(scene_, torque));
    if (rotors()) kind += static_cast<char>(LaneTorque::Kind::rotors);
    return kind;
  }

  std::string describe_state() const override { return attitude_ ? "omega, attitude" : "omega"; }

  void unpack(const double* y, double* omega, double* attitude) const override {
    attitude_ ? EulerProblem<NoTorque, true, true>::unpack(y, omega, attitude)
              : EulerProblem<NoTorque, true, false>::unpack(y, omega, attitude);
  }

  std::unique_ptr<LaneIntegrator> make_integrator(const ode::Tolerances& tolerances) const override;

 private:
  const Scene& scene_;
  bool diagonal_, attitude_;
};

class Rk45Integrator final : public LaneIntegrator {
 public:
  Rk45Integrator(const EulerLaneProblem& first, const ode::Tolerances& tolerances)
      : kernels_(find_kernels(first.diagonal(), first.attitude())),
        tolerances_(tolerances),
        torques_(first.scene().torques().size() + first.rotors()) {
    b_.rtol = tolerances.rtol, b_.atol = tolerances.atol;
    const std::vector<AnyTorque>& given = first.scene().torques();
    for (std::size_t i = 0; i < given.size(); ++i) torques_[i].kind = *describe(first.scene(), given[i]);
    if (first.rotors()) torques_.back().kind = LaneTorque::Kind::rotors;   // last, as in SeveralTorques
    b_.torques = torques_.data(), b_.torque_count = static_cast<int>(torques_.size());
  }

  LaneState& state() override { return b_; }

  void load(int lane, const LaneProblem& problem) override {
    const auto& body = static_cast<const EulerLaneProblem&>(problem);
    const std::vector<AnyTorque>& given = body.scene().torques();
    for (std::size_t i = 0; i < given.size(); ++i) {
      double values[9] = {};
      describe(body.scene(), given[i], values);
      put(torques_[i].values, lane, values, 9);
    }
    if (body.rotors()) put(torques_.back().values, lane, body.scene().rotor_momentum().data(), 3);
    if (body.diagonal()) {
      body.attitude() ? start<true, true>(lane, body.scene()) : start<true, false>(lane, body.scene());
    } else {
      body.attitude() ? start<false, true>(lane, body.scene()) : start<false, false>(lane, body.scene());
    }
    b_.log_previous[lane] = ode::rough_log2(ode::StepControl::least_error);
    b_.rejected[lane] = b_.not_finite[lane] = 0.0;
  }

  void clear(int lane) override {
    for (int i = 0; i < 7; ++i) b_.y[i][lane] = b_.f[i][lane] = 0.0;
    b_.time[lane] = b_.t_end[lane] = b_.step[lane] = 0.0;
  }

  unsigned advance(int rounds) override { return kernels_.advance(b_, rounds); }
  double find_position(int lane, double t) const override { return (t - b_.time_old[lane]) / b_.step_taken[lane]; }
  void sample(const double* positions, double (*y)[width]) override { kernels_.sample(b_, positions, y); }

 private:
  /// Fills a lane: constants, start, derivative at the start, first step.
  template <bool diagonal, bool attitude>
  void start(int lane, const Scene& scene) {
    using Problem = EulerProblem<SeveralTorques, diagonal, attitude>;
    const SeveralTorques torques = scene.all_torques();
    const Problem problem(scene.inertia_B(), torques);
    put(b_.inertia, lane, scene.inertia_B().matrix().data(), 9), put(b_.inverse, lane, problem.inverse().data(), 9);
    put(b_.difference, lane, problem.difference(), 3), put(b_.inverse_moment, lane, problem.inverse_moment(), 3);
    double y[Problem::dimension], f[Problem::dimension];
    const double t0 = b_.time[lane], t_end = b_.t_end[lane];
    const auto compute = [&](double t, const double* at, double* change) { problem.compute_derivative(t, at, change); };
    Problem::pack(scene.start(), y);
    compute(t0, y, f);
    put(b_.y, lane, y, Problem::dimension), put(b_.f, lane, f, Problem::dimension);
    b_.step[lane] = ode::choose_first_step(problem, tolerances_, ode::Rk45::record.order, t0, y, f, t_end, compute);
  }

  Rk45Block b_;
  Rk45Kernels kernels_;
  ode::Tolerances tolerances_;
  std::vector<LaneTorque> torques_;
};

std::unique_ptr<LaneIntegrator> EulerLaneProblem::make_integrator(const ode::Tolerances& tolerances) const {
  return std::make_unique<Rk45Integrator>(*this, tolerances);
}

/// Not a callable, which serves one body at a time, nor a torque with windows, which cut the span into pieces.
bool accepts_all(const Scene& scene) {
  return std::ranges::all_of(scene.torques(),
                             [&](const AnyTorque& torque) { return describe(scene, torque).has_value(); });
}

}  // namespace

const LaneMethod rk45_lanes{ode::Rk45::record, &accepts_all,
                            [](const Scene& scene, const LaneProblem*) -> std::unique_ptr<LaneProblem> {
                              return std::make_unique<EulerLaneProblem>(scene);
                            }};

}  // namespace polhode
