#include "batch/formula_lanes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "batch/lanes/formula_block.hpp"
#include "batch/series_integrator.hpp"
#include "core/choose_level.hpp"
#include "polhode/core/simd.hpp"
#include "polhode/formula/expression.hpp"
#include "polhode/formula/program.hpp"

namespace polhode {
namespace {

using formula::Form;
using formula::Tape;
using math::DD;

FormulaKernels find_kernels() {
  return choose_level(simd_level(), baseline_formula_lanes, avx2_formula_lanes, avx512_formula_lanes);
}

/// tau_B as extras, beside states whose rates the lanes have themselves.
Tape make_tape(const Scene& scene) {
  formula::Program made;
  std::vector<Form> body;
  for (int i = 0; i < formula::first_extra; ++i) body.push_back(made.graph.state(i)), made.outputs.emplace_back();
  std::vector<Form> tau(3);
  for (const AnyTorque& torque : scene.torques()) {
    const formula::Program law = make_bound_law(torque, scene.inertia_B().matrix());
    const std::vector<Form> outputs = formula::embed(law, made.graph, body, nullptr);
    for (std::size_t i = 0; i < 3; ++i) tau[i] = tau[i] + outputs[i];
  }
  made.outputs.insert(made.outputs.end(), tau.begin(), tau.end());
  return Tape(formula::rewrite(made), formula::first_extra);
}

/// All of a tape but its numbers: tapes of equal structure run side by side.
std::string describe_structure(const Tape& tape) {
  std::string text;
  const auto add = [&](auto... numbers) {
    for (const int number : {static_cast<int>(numbers)...})
      text.append(reinterpret_cast<const char*>(&number), sizeof number);
  };
  const auto add_form = [&](const Form& form) {
    add(form.terms.size());
    for (const formula::Term& term : form.terms) add(term.node);
  };
  for (const formula::Slot& slot : tape.slots()) add(slot.kind, slot.index);
  for (const formula::StateSlot& state : tape.state_slots()) add(state.start, state.number, state.slot);
  for (const auto* forms : {&tape.forms(), &tape.extra_forms()})
    for (const Form& form : *forms) add_form(form);
  for (const formula::Wave& wave : tape.waves()) add(wave.seen);
  for (const formula::Recurrence& op : tape.operations())
    add(op.rule, op.a, op.b, op.left, op.right, op.left_weighted, op.divided, op.first, op.second);
  for (const formula::CarriedVector& vector : tape.carried()) add(vector.rate != 0.0);
  return text;
}

/// The recurrences of the torques of a body, shared by all bodies under the same ones.
struct SharedTape {
  explicit SharedTape(Tape made)
      : tape(std::move(made)), numbers(list_numbers(tape)), structure(describe_structure(tape)) {}
  Tape tape;
  std::vector<double> numbers;
  std::string structure;
};

bool are_same(const Scene& a, const Scene& b) {
  if (a.torques().size() != b.torques().size()) return false;
  for (std::size_t i = 0; i < a.torques().size(); ++i) {
    const AnyTorque &one = a.torques()[i], &other = b.torques()[i];
    if (one.index() != other.index()) return false;
    if (const auto* formula = std::get_if<torques::Formula>(&one)) {
      if (!(*formula == std::get<torques::Formula>(other))) return false;
    } else if (!formula::is_same(make_bound_law(one, a.inertia_B().matrix()),
                                 make_bound_law(other, b.inertia_B().matrix()))) {
      return false;
    }
  }
  return true;
}

class FormulaLaneProblem final : public LaneProblem {
 public:
  FormulaLaneProblem(const Scene& scene, const FormulaLaneProblem* before) : scene_(scene) {
    const bool shares = before != nullptr && are_same(scene, before->scene_);
    tape_ = shares ? before->tape_ : std::make_shared<const SharedTape>(make_tape(scene));
    const InertiaTensor& inertia = scene.inertia_B();
    rotated_ = !inertia.is_diagonal();
    moments_ = rotated_ ? inertia.moments() : Vector3d(inertia.matrix().diagonal());
    if (rotated_) R_BP_ = inertia.axes();
    const Vector3d w = R_BP_.transpose() * scene.omega();
    const Quat& q = scene.attitude();
    const double y[8] = {w[0], w[1], w[2], 0.0, q.x, q.y, q.z, q.w};
    std::copy_n(y, 8, start_);
  }

  const Scene& scene() const { return scene_; }
  const std::shared_ptr<const SharedTape>& tape() const { return tape_; }
  bool is_rotated() const { return rotated_; }
  bool has_rotors() const { return !scene_.rotor_momentum().isZero(0.0); }
  const Vector3d& moments() const { return moments_; }
  const Matrix3d& axes() const { return R_BP_; }
  const double* start() const { return start_; }

  std::string kind() const override {
    return std::string("formula") + static_cast<char>(rotated_) + static_cast<char>(has_rotors()) + tape_->structure;
  }
  std::string describe_state() const override { return "omega, attitude"; }
  void unpack(const double* y, double* omega, double* attitude) const override {
    const Vector3d w = R_BP_ * Vector3d(y[0], y[1], y[2]);
    std::copy_n(w.data(), 3, omega), std::copy_n(y + 4, 4, attitude);
  }
  std::unique_ptr<LaneIntegrator> make_integrator(const ode::Tolerances& tolerances) const override;

 private:
  const Scene& scene_;
  std::shared_ptr<const SharedTape> tape_;
  bool rotated_ = false;
  Vector3d moments_;
  Matrix3d R_BP_ = Matrix3d::Identity();
  double start_[8] = {};
};

/// Numbers of memory at a boundary of 64 bytes.
class Aligned {
 public:
  explicit Aligned(std::size_t n) : numbers_(n + 8) {}
  double* get() {
    const auto address = reinterpret_cast<std::uintptr_t>(numbers_.data());
    return numbers_.data() + (64 - address % 64) % 64 / sizeof(double);
  }

 private:
  std::vector<double> numbers_;
};

class FormulaIntegrator final : public SeriesIntegrator {
 public:
  FormulaIntegrator(const FormulaLaneProblem& first, const ode::Tolerances& tolerances)
      : SeriesIntegrator(b_), kernels_(find_kernels()),
        code_(first.tape()->tape, first.is_rotated(), choose_lane_order(tolerances)), rows_(code_.size),
        numbers_(8 * code_.numbers), older_(16 * code_.products.size()), starts_(24 * code_.starts) {
    put_tolerances(tolerances);
    b_.code = &code_, b_.rotors = first.has_rotors();
    b_.rows = rows_.get(), b_.numbers = numbers_.get(), b_.older = older_.get(), b_.starts = starts_.get();
    for (int lane = 0; lane < width; ++lane) put_tape(lane, first.tape());
  }

  void load(int lane, const LaneProblem& problem) override {
    const auto& body = static_cast<const FormulaLaneProblem&>(problem);
    put_tape(lane, body.tape());
    const Vector3d& I = body.moments();
    const Vector3d h_P = body.axes().transpose() * body.scene().rotor_momentum();
    for (int i = 0; i < 3; ++i) {
      const DD product = math::two_diff(I[(i + 1) % 3], I[(i + 2) % 3]) / DD(I[i]);
      b_.product[i][lane] = product.hi, b_.product_low[i][lane] = product.lo;
      b_.inverse[i][lane] = 1.0 / I[i], b_.momentum[i][lane] = h_P[i];
      for (int j = 0; j < 3; ++j) b_.axes[i][j][lane] = body.axes()(i, j);
    }
    const double carry[8] = {};
    put_start(lane, body.start(), carry, find_time_scale(body));
  }

  void sample(const double* positions, double (*y)[width]) override { kernels_.sample(b_, positions, y); }

 private:
  void put_tape(int lane, const std::shared_ptr<const SharedTape>& tape) {
    tapes_[lane] = tape, b_.tapes[lane] = &tape->tape;
    double* to = b_.numbers + lane;
    for (const double number : tape->numbers) *to = number, to += width;
  }

  /// From the rates, and from the torque as if the body rested.
  static double find_time_scale(const FormulaLaneProblem& body) {
    const Scene& scene = body.scene();
    const Quat& q = scene.attitude();
    const double attitude[4] = {q.x, q.y, q.z, q.w};
    double tau[3] = {};
    scene.all_torques().add({scene.t0(), scene.omega().data(), attitude, scene.inertia_B().matrix()}, tau);
    const double acceleration = Vector3d(tau[0], tau[1], tau[2]).norm() / body.moments().minCoeff();
    const double rate = std::max(scene.omega().norm(), std::sqrt(acceleration));
    return rate > 0.0 ? 1.0 / rate : 0x1p900;
  }

  void step() override {
    for (int lane = 0; lane < width; ++lane) put_known(lane);
    kernels_.step(b_);
  }

  /// Waves, and what rotates at a known rate.
  void put_known(int lane) {
    const Tape& tape = *b_.tapes[lane];
    const DD t(b_.time[lane], b_.time_low[lane]);
    places_.assign(tape.waves().size(), -1);
    for (const FormulaCode::Known& wave : code_.waves)
      places_[static_cast<std::size_t>(wave.index)] = wave.place.offset + lane;
    if (!code_.waves.empty()) tape.fill_waves(t, b_.unit[lane], b_.order, places_, b_.rows, width);
    for (std::size_t i = 0; i < code_.vectors.size(); ++i) {
      if (!code_.vectors[i].rotates) continue;
      const formula::CarriedVector& vector = tape.carried()[i];
      double s, c;
      formula::fill_wave({vector.phase, vector.rate, true}, t, 1.0, 0, &c, 1);
      formula::fill_wave({vector.phase, vector.rate, false}, t, 1.0, 0, &s, 1);
      for (int k = 0; k < 3; ++k)
        b_.rows[code_.vectors[i].place[k].offset + lane] = c * vector.cosine[k] + s * vector.sine[k];
    }
  }

  FormulaKernels kernels_;
  FormulaBlock b_;
  FormulaCode code_;
  Aligned rows_, numbers_, older_, starts_;
  std::vector<std::ptrdiff_t> places_;   ///< of the waves of a lane
  std::shared_ptr<const SharedTape> tapes_[width];
};

std::unique_ptr<LaneIntegrator> FormulaLaneProblem::make_integrator(const ode::Tolerances& tolerances) const {
  return std::make_unique<FormulaIntegrator>(*this, tolerances);
}

}  // namespace

std::unique_ptr<LaneProblem> make_formula_lane(const Scene& scene, const LaneProblem* before) {
  return std::make_unique<FormulaLaneProblem>(scene, dynamic_cast<const FormulaLaneProblem*>(before));
}

}  // namespace polhode
