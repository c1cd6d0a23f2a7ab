#include "derivative/column_run.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "method/samples.hpp"
#include "derivative/changing_columns.hpp"
#include "derivative/column_motion.hpp"
#include "polhode/core/error.hpp"
#include "polhode/core/interrupt.hpp"
#include "polhode/formula/sides.hpp"

namespace polhode {

using Of = SceneParameter::Of;
using torques::Window;

/// A state with its columns: d omega, the small rotation and the changes of states, (numbers, columns) in body axes.
struct ColumnRun::Moment {
  State state;
  std::vector<double> columns;
  std::size_t count;   ///< of columns

  double& at(std::size_t row, std::size_t c) { return columns[row * count + c]; }
  void add(std::size_t first_row, std::size_t c, const Vector3d& v) {
    for (int i = 0; i < 3; ++i) at(first_row + static_cast<std::size_t>(i), c) += v[i];
  }
};

namespace {

/// The axis of a parameter's component; zero for those of a matrix beyond the third, which have no axis.
Vector3d unit_vector(const SceneParameter& parameter) {
  return parameter.component < 3 ? Vector3d(Vector3d::Unit(parameter.component)) : Vector3d(Vector3d::Zero());
}

/// Ends of windows of torques that vanish, at which nothing else cuts the span.
std::vector<double> find_further_ends(const Scene& scene) {
  const auto [least, most] = std::minmax_element(scene.times().begin(), scene.times().end());
  const double first = std::min(scene.t0(), *least), last = std::max(scene.t0(), *most);
  std::vector<double> ends;
  for (const AnyTorque& torque : scene.torques()) {
    const auto* during = std::get_if<torques::During>(&torque);
    if (during == nullptr || !during->traits().vanishes) continue;
    for (const Window& window : during->windows())
      for (const double t : {window.begin, window.end})
        if (first < t && t < last) ends.push_back(t);
  }
  return ends;
}

/// Whether a formula has friction, whose torque at a time depends on all others.
bool has_friction(const Scene& scene) {
  return std::any_of(scene.torques().begin(), scene.torques().end(), [&](const AnyTorque& torque) {
    const torques::Formula* formula = find_formula(torque);
    if (formula == nullptr || !formula->has_switches()) return false;
    const std::vector<bool> holds = formula::list_sided_guards(formula->program(scene.inertia_B().matrix())).holds;
    return std::find(holds.begin(), holds.end(), true) != holds.end();
  });
}

}  // namespace

ColumnRun::ColumnRun(const Scene& scene, const std::vector<SceneParameter>& parameters, RotationSide side,
                     const LoopOptions& loop)
    : scene_(scene),
      parameters_(parameters),
      side_(side),
      loop_(loop),
      pieces_(cut(scene, find_further_ends(scene))),
      states_(static_cast<std::size_t>(scene.count_states())) {
  if (scene.changes()) require_fixed_body(scene, parameters);
  const bool by_windows = std::any_of(parameters.begin(), parameters.end(), [](const SceneParameter& parameter) {
    return parameter.of == Of::torque_windows || parameter.of == Of::rotor_windows;
  });
  if (by_windows && has_friction(scene))
    throw InvalidInput("sensitivity", "without times of windows in a scene with friction", "such a time",
                       "the torque of a friction that holds jumps there, too");
  const Matrix3d& R_BP = scene.inertia_B().axes();
  J_inverse_ = R_BP * Matrix3d(scene.inertia_B().moments().cwiseInverse().asDiagonal()) * R_BP.transpose();
  if (scene.inertia_B().is_diagonal())
    J_inverse_ = scene.inertia_B().matrix().diagonal().cwiseInverse().asDiagonal();
  for (const Rotor& rotor : scene.rotors()) momenta_.push_back(rotor.compute_momentum(scene.omega()) * rotor.axis());
  for (const SceneParameter& parameter : parameters) inertia_change_.push_back(find_inertia_change(parameter));
}

Matrix3d ColumnRun::find_inertia_change(const SceneParameter& parameter) const {
  const InertiaTensor& given = scene_.given_inertia_B();
  const Vector3d unit = unit_vector(parameter);
  if (parameter.of == Of::inertia) {
    const Vector3d axis = given.is_diagonal() ? unit : Vector3d(given.axes().col(parameter.component));
    return axis * axis.transpose();
  }
  if (parameter.of == Of::axes) {   // E J E^T with E = 1 + [unit]x
    Matrix3d crossed;
    for (int c = 0; c < 3; ++c) crossed.col(c) = unit.cross(Vector3d(given.matrix().col(c)));
    return crossed + crossed.transpose();
  }
  if (parameter.of == Of::rotor && parameter.field == SceneParameter::inertia &&
      scene_.rotors()[parameter.index].free()) {
    const Vector3d& axis = scene_.rotors()[parameter.index].axis();
    return -axis * axis.transpose();
  }
  return Matrix3d::Zero();
}

Vector3d ColumnRun::find_momentum_change(const SceneParameter& parameter, const std::vector<bool>& rotating) const {
  Vector3d change = Vector3d::Zero();
  for (std::size_t k = 0; k < rotating.size(); ++k) {
    if (!rotating[k]) continue;
    const Rotor& rotor = scene_.rotors()[k];
    if (rotor.is_driven()) continue;   // its momentum is a state
    const Vector3d& axis = rotor.axis();
    const bool own = parameter.of == Of::rotor && parameter.index == k;
    if (own && parameter.field == SceneParameter::momentum) change += axis;
    if (rotor.momentum()) continue;   // inertia and speed do not change it
    if (own && parameter.field == SceneParameter::speed) change += *rotor.inertia() * axis;
    if (own && parameter.field == SceneParameter::inertia)
      change += (rotor.compute_momentum(scene_.omega()) / *rotor.inertia()) * axis;
    if (parameter.of == Of::omega && rotor.free()) change += *rotor.inertia() * axis[parameter.component] * axis;
  }
  return change;
}

std::vector<bool> ColumnRun::find_rotating(const Piece& piece) const {
  const double from = std::min(piece.begin, piece.end), to = std::max(piece.begin, piece.end);
  std::vector<bool> rotating;
  for (const Rotor& rotor : scene_.rotors())
    rotating.push_back(from < to ? rotor.rotates_throughout(from, to) : rotor.rotates_at(from));
  return rotating;
}

std::vector<ColumnCause> ColumnRun::find_causes(const Piece& piece, const std::vector<bool>& rotating) const {
  const double from = std::min(piece.begin, piece.end), to = std::max(piece.begin, piece.end);
  std::vector<ColumnCause> causes(parameters_.size());
  for (std::size_t c = 0; c < causes.size(); ++c) {
    const SceneParameter& parameter = parameters_[c];
    causes[c].inertia = inertia_change_[c];
    causes[c].rotor_momentum = find_momentum_change(parameter, rotating);
    if (parameter.of == Of::rotor && parameter.field == SceneParameter::inertia &&
        scene_.rotors()[parameter.index].is_driven()) {
      const std::size_t own = find_torque_of_state(scene_, scene_.rotors()[parameter.index].state());
      causes[c].torque = drop_windows(scene_.torques()[own]);
      causes[c].field = find_field(*find_formula(scene_.torques()[own]), "inertia"), causes[c].component = 0;
    }
    if (parameter.of != Of::torque) continue;
    const AnyTorque& torque = scene_.torques()[parameter.index];
    const auto* during = std::get_if<torques::During>(&torque);
    if (during != nullptr && !(from < to ? during->acts_throughout(from, to) : during->acts_at(from))) continue;
    causes[c].torque = drop_windows(torque);
    causes[c].field = parameter.field, causes[c].component = parameter.component;
    if (piece.changes) find_scaled(scene_, piece, parameter.index, causes[c]);
  }
  return causes;
}

/// Adds the derivatives of the momenta that driven rotors and the damper start with.
void ColumnRun::start_momenta(const SceneParameter& by, const std::function<void(int, double)>& add) const {
  const auto find = [&](const std::string& name) { return formula::find_place(scene_.states(), name).first; };
  for (std::size_t k = 0; k < scene_.rotors().size(); ++k) {
    const Rotor& rotor = scene_.rotors()[k];
    if (!rotor.is_driven()) continue;
    const int state = find(rotor.state());
    const bool own = by.of == Of::rotor && by.index == k;
    if (own && by.field == SceneParameter::momentum) add(state, 1.0);
    if (rotor.momentum()) continue;
    if (own && by.field == SceneParameter::speed) add(state, *rotor.inertia());
    if (own && by.field == SceneParameter::inertia)
      add(state, rotor.compute_start_momentum(scene_.omega()) / *rotor.inertia());
    if (by.of == Of::omega && rotor.free()) add(state, *rotor.inertia() * rotor.axis()[by.component]);
  }
  if (scene_.damper() && by.of == Of::omega) add(find(scene_.damper()->state()) + by.component, scene_.damper()->inertia());
}

std::vector<double> ColumnRun::start_columns() const {
  const std::size_t count = parameters_.size();
  Moment start{scene_.start(), std::vector<double>((6 + states_) * count, 0.0), count};
  for (std::size_t c = 0; c < count; ++c) {
    const Vector3d unit = unit_vector(parameters_[c]);
    if (parameters_[c].of == Of::omega) start.add(0, c, unit);
    if (parameters_[c].of == Of::state) start.at(6 + parameters_[c].index, c) = 1.0;
    start_momenta(parameters_[c], [&](int state, double slope) { start.at(6 + static_cast<std::size_t>(state), c) += slope; });
    if (parameters_[c].of == Of::attitude)
      start.add(3, c, side_ == RotationSide::body ? unit : rotate(conjugate(scene_.attitude()), unit));
  }
  return std::move(start.columns);
}

Vector3d ColumnRun::accelerate(const Moment& at, const std::vector<AnyTorque>& torques, const Vector3d& h) const {
  const Matrix3d& J = scene_.inertia_B().matrix();
  const Vector3d& w = at.state.omega;
  const Quat& q = at.state.attitude;
  const double attitude[4] = {q.x, q.y, q.z, q.w};
  Vector3d N = -w.cross(Vector3d(J * w + h));
  const TorqueInput in{at.state.t, w.data(), attitude, J};
  std::vector<AnyTorque> now = torques;
  if (states_ > 0) set_starts(now, at.state.states);
  for (const AnyTorque& torque : now) std::visit([&](const auto& one) { one.add(in, N.data()); }, torque);
  return divide(N);
}

std::vector<double> ColumnRun::find_state_rates(const Moment& at, const std::vector<AnyTorque>& torques) const {
  std::vector<double> rates(states_);
  std::vector<AnyTorque> now = torques;
  if (states_ > 0) set_starts(now, at.state.states);
  const Quat& q = at.state.attitude;
  const double attitude[4] = {q.x, q.y, q.z, q.w};
  for (const AnyTorque& torque : now) {
    const torques::Formula* formula = find_formula(torque);
    if (formula == nullptr || formula->states().empty()) continue;
    const std::vector<double> outputs =
        formula->compute({at.state.t, at.state.omega.data(), attitude, scene_.inertia_B().matrix()},
                         formula::list_values(formula->states()));
    std::size_t next = 3;
    for (const formula::Input& state : formula->states()) {
      const formula::Place place = formula::find_place(scene_.states(), state.name);
      for (int i = 0; i < place.count; ++i) rates[static_cast<std::size_t>(place.first + i)] = outputs[next++];
    }
  }
  return rates;
}

/// Carries a state and its columns over a time at which torques or rotors start or stop. With phi the jump of the
/// state, f the derivative by time before it and g the one after, a column becomes phi' column + (phi' f - g) d(time).
void ColumnRun::cross(const Piece& before, const std::vector<bool>& from, const std::vector<bool>& to, bool forward,
                      Moment& at) const {
  Vector3d h_from = Vector3d::Zero(), h_to = Vector3d::Zero();
  for (std::size_t k = 0; k < momenta_.size(); ++k) {
    if (from[k]) h_from += momenta_[k];
    if (to[k]) h_to += momenta_[k];
  }
  Moment after{at.state, {}, 0};
  after.state.omega += compute_rate_jump(scene_.inertia_B(), h_to - h_from);
  const double sign = forward ? 1.0 : -1.0, t = at.state.t;
  for (std::size_t c = 0; c < parameters_.size(); ++c) {
    const SceneParameter& parameter = parameters_[c];
    const Vector3d dh = find_momentum_change(parameter, to) - find_momentum_change(parameter, from);
    at.add(0, c, divide(inertia_change_[c] * divide(h_to - h_from) - dh));
    if (parameter.of == Of::torque_windows) {
      const auto& during = std::get<torques::During>(scene_.torques()[parameter.index]);
      const Window& window = during.windows()[static_cast<std::size_t>(parameter.field)];
      if ((parameter.component == 0 ? window.begin : window.end) != t || t == scene_.t0()) continue;
      const Vector3d none = accelerate(at, {}, h_from);
      const Vector3d own = accelerate(at, {to_any(during.torque())}, h_from) - none;
      at.add(0, c, parameter.component == 0 ? -sign * own : sign * own);
    } else if (parameter.of == Of::rotor_windows) {
      const Window& window = scene_.rotors()[parameter.index].windows()[static_cast<std::size_t>(parameter.field)];
      if ((parameter.component == 0 ? window.begin : window.end) != t || t == scene_.t0()) continue;
      // This end alone moves, also where others start or stop.
      const Vector3d own = ((parameter.component == 0) == forward ? 1.0 : -1.0) * momenta_[parameter.index];
      Moment moved{at.state, {}, 0};
      moved.state.omega += compute_rate_jump(scene_.inertia_B(), own);
      at.add(0, c, accelerate(at, before.torques, h_from) - accelerate(moved, before.torques, h_from + own));
      at.add(3, c, at.state.omega - moved.state.omega);
      const std::vector<double> from_rates = find_state_rates(at, before.torques),
                                to_rates = find_state_rates(moved, before.torques);
      for (std::size_t i = 0; i < states_; ++i) at.at(6 + i, c) += from_rates[i] - to_rates[i];
    }
  }
  at.state.omega = after.state.omega;
}

void ColumnRun::change(const Momentum& before, const Momentum& after, Moment& at) const {
  if (before == after) return;
  for (std::size_t c = 0; c < parameters_.size(); ++c) {
    const Vector3d own{at.at(0, c), at.at(1, c), at.at(2, c)};
    at.add(0, c, carry_rates(scene_, own, before, after) - own);
  }
  at.state.omega += compute_rate_jump(scene_, at.state.omega, before, after);
}

ColumnSamples ColumnRun::run(double rtol, long max_steps, std::size_t most) const {
  const std::size_t samples = scene_.times().size(), columns = parameters_.size();
  ColumnSamples out;
  out.omega.resize(3 * samples), out.attitude.resize(4 * samples);
  out.d_omega.resize(3 * columns * samples), out.theta.resize(3 * columns * samples);
  out.d_states.resize(states_ * columns * samples);
  SampleOrder order(scene_.times(), scene_.t0());
  for (auto* direction : {&order.forward, &order.backward}) {
    if (most == 0 || direction->size() <= most) continue;
    std::vector<std::size_t> kept;
    const std::size_t every = (direction->size() + most - 1) / most;
    for (std::size_t i = direction->size() - 1; i < direction->size(); i -= every) kept.push_back((*direction)[i]);
    std::reverse(kept.begin(), kept.end());
    *direction = std::move(kept);
  }
  out.samples = order.backward;
  out.samples.insert(out.samples.end(), order.forward.begin(), order.forward.end());
  if (!scene_.controllers().empty()) {
    follow_clock(pieces_.forward.front(), order.forward, rtol, max_steps, out);
    return out;
  }
  follow(pieces_.forward, order.forward, rtol, max_steps, out);
  follow(pieces_.backward, order.backward, rtol, max_steps, out);
  return out;
}

void ColumnRun::follow(const std::vector<Piece>& pieces, const std::vector<std::size_t>& order, double rtol,
                       long max_steps, ColumnSamples& out) const {
  if (order.empty()) return;
  SampleTarget target(out, states_, parameters_.size());
  const bool forward = pieces.back().end >= scene_.t0();
  Moment at{scene_.start(), start_columns(), parameters_.size()};
  std::vector<bool> rotating;
  for (const Rotor& rotor : scene_.rotors()) rotating.push_back(rotor.rotates_at(scene_.t0()));
  std::size_t next = 0;
  const auto put_now = [&] {   // samples at the very time that was reached
    const Quat& q = at.state.attitude;
    const double attitude[4] = {q.x, q.y, q.z, q.w};
    for (; next < order.size() && scene_.times()[order[next]] == at.state.t; ++next)
      target.put(order[next], at.state.omega.data(), attitude, at.columns.data());
  };
  put_now();
  const Piece* before = &pieces.front();
  Momentum momentum = find_momentum(scene_, scene_.t0());
  for (const Piece& piece : pieces) {
    const bool last = &piece == &pieces.back();
    if (!forward) put_now();
    const std::vector<bool> here = find_rotating(piece);
    if (scene_.changes()) {
      change(momentum, find_momentum(scene_, piece, piece.begin), at);
      momentum = find_momentum(scene_, piece, piece.end);
    } else if (&piece != before || here != rotating) cross(*before, rotating, here, forward, at);
    put_now();
    rotating = here, before = &piece;
    if (piece.end == at.state.t) continue;
    const Scene part = make_piece_scene(scene_, piece, at.state, {piece.end}, {true, true});
    const auto motion = make_column_motion(part, find_causes(piece, rotating), at.columns, piece.end, {.rtol = rtol},
                                           equations_[&piece]);
    while (motion->t() != piece.end) {
      check_interrupt();
      if (out.steps++ >= max_steps)
        throw IntegrationFailure(motion->t(), "sensitivity: more than " + std::to_string(max_steps) + " steps");
      const ode::StepResult result = motion->advance(piece.end);
      if (result == ode::StepResult::sliding || result == ode::StepResult::chattering)
        throw IntegrationFailure(motion->t(), "sensitivity: the motion stays on the surface of a switch");
      if (result != ode::StepResult::accepted)
        throw IntegrationFailure(motion->t(), "sensitivity: the motion or its derivatives leave the range of float64");
      // Samples at the end of the piece come after what happens there.
      std::size_t count = 0;
      const auto within = [&](double t) { return (forward ? t <= motion->t() : t >= motion->t()) && t != piece.end; };
      while (next + count < order.size() && within(scene_.times()[order[next + count]])) ++count;
      if (count == 0) continue;
      target.put(*motion, scene_.times(), order.data() + next, count);
      next += count;
    }
    motion->end(at.state, at.columns);
    if (!last) continue;
    std::vector<bool> then;
    for (const Rotor& rotor : scene_.rotors()) then.push_back(rotor.rotates_at(at.state.t));
    if (forward && scene_.changes()) change(momentum, find_momentum(scene_, at.state.t), at);
    else if (forward) cross(piece, rotating, then, forward, at);   // as if later samples followed
    put_now();
  }
}

}  // namespace polhode
