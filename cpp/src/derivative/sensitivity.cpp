#include "polhode/derivative/sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "method/series/switched_series.hpp"
#include "polhode/core/error.hpp"
#include "polhode/math/detail/functions.hpp"
#include "polhode/solve/facts.hpp"
#include "derivative/column_run.hpp"
#include "solve/ground/formulas.hpp"

namespace polhode {
namespace {

constexpr double finer = 1.0 / 16.0;        // the tolerance of a run over that of the one before
constexpr double least_tolerance = 1e-16;
constexpr double rounding = 4e-15;          // in each turn, of what both runs round alike
// Of loops: a law may subtract measurements that are nearly equal, and both runs lose the same digits.
constexpr double rounding_of_laws = 1e-12;
constexpr double margin = 4.0;              // of the difference of two runs, as the error of the second
constexpr double unsure = 0.1;              // of the largest difference, that every column gets
constexpr int most_runs = 5;
constexpr std::size_t samples_compared = 64;   // samples of the first run

/// The larger of |d omega| / scale and the angle of one column, whose components are `stride` apart.
double measure(const double* d_omega, const double* theta, std::size_t stride, double scale) {
  const double rate = math::hypot(d_omega[0], d_omega[stride], d_omega[2 * stride]) / scale;
  return std::max(rate, math::hypot(theta[0], theta[stride], theta[2 * stride]));
}

double find_rate_scale(const Scene& scene, const std::vector<double>& omega) {
  double scale = math::hypot(scene.omega()[0], scene.omega()[1], scene.omega()[2]);
  for (std::size_t i = 0; i + 2 < omega.size(); i += 3)
    scale = std::max(scale, math::hypot(omega[i], omega[i + 1], omega[i + 2]));
  return scale > 0.0 ? scale : 1.0;
}

/// The largest difference of each column over its size, in the samples of the first run.
std::vector<double> compare(const ColumnSamples& a, const ColumnSamples& b, std::size_t columns, double scale) {
  std::vector<double> error(columns, 0.0);
  for (const std::size_t i : a.samples) {
    for (std::size_t c = 0; c < columns; ++c) {
      const std::size_t at = 3 * columns * i + c;
      double d_omega[3], theta[3];
      for (std::size_t k = 0; k < 3; ++k) {
        d_omega[k] = a.d_omega[at + k * columns] - b.d_omega[at + k * columns];
        theta[k] = a.theta[at + k * columns] - b.theta[at + k * columns];
      }
      const double size = measure(&b.d_omega[at], &b.theta[at], columns, scale);
      const double apart = measure(d_omega, theta, 1, scale);
      if (!(apart <= size * error[c])) error[c] = apart / size;
    }
  }
  const std::size_t states = b.d_states.size() / std::max<std::size_t>(columns * b.omega.size() / 3, 1);
  for (std::size_t k = 0; k < states; ++k) {
    for (std::size_t c = 0; c < columns; ++c) {
      double apart = 0.0, size = 0.0;
      for (const std::size_t i : a.samples) {
        const std::size_t at = (states * i + k) * columns + c;
        const double difference = std::abs(a.d_states[at] - b.d_states[at]);
        if (!(difference <= apart)) apart = difference;
        size = std::max(size, std::abs(b.d_states[at]));
      }
      if (!(apart <= size * error[c])) error[c] = apart / size;
    }
  }
  return error;
}

/// Small rotations in space axes from those in body axes.
void rotate_to_space(const std::vector<double>& attitude, std::size_t columns, std::vector<double>& theta) {
  for (std::size_t i = 0; 4 * i < attitude.size(); ++i) {
    const double* q = &attitude[4 * i];
    const Quat q_WB{q[0], q[1], q[2], q[3]};
    for (std::size_t c = 0; c < columns; ++c) {
      double* first = &theta[3 * columns * i + c];
      const Vector3d rotated = rotate(q_WB, {first[0], first[columns], first[2 * columns]});
      for (std::size_t k = 0; k < 3; ++k) first[k * columns] = rotated[static_cast<Eigen::Index>(k)];
    }
  }
}

std::vector<SceneParameter> find_all(const Scene& scene, const std::vector<std::string>& groups) {
  std::vector<SceneParameter> all;
  for (const std::string& group : groups) {
    for (SceneParameter& parameter : find_parameters(scene, group)) {
      for (const SceneParameter& other : all)
        if (other.column == parameter.column)
          throw InvalidInput("sensitivity", "of each number once", "'" + group + "'");
      all.push_back(std::move(parameter));
    }
  }
  return all;
}

void require_formulas(const Scene& scene) {
  std::vector<AnyTorque> torques = scene.torques();
  for (AnyTorque& torque : torques) torque = to_any(drop_windows(torque));
  const Scene lasting = scene.with_torques(std::move(torques));
  const std::string why = compute_series_refusal(lasting);
  if (!why.empty())
    throw InvalidInput("sensitivity", "left out for a torque without a formula that can be differentiated", why);
}

/// The scene with the torques of the list that its formulas are. A formula that is differentiated by its own numbers
/// stays one, and so does each while the inertia changes.
Scene resolve(const Scene& scene, const std::vector<SceneParameter>& parameters) {
  using Of = SceneParameter::Of;
  std::vector<AnyTorque> torques = scene.torques();
  for (std::size_t i = 0; i < torques.size(); ++i) {
    const bool stays = std::any_of(parameters.begin(), parameters.end(), [&](const SceneParameter& parameter) {
      return parameter.of == Of::inertia || parameter.of == Of::axes || parameter.of == Of::rotor ||
             (parameter.of == Of::torque && parameter.index == i);
    });
    if (stays) torques[i] = as_given(torques[i]);
  }
  return resolve_formulas(scene.with_torques(std::move(torques)), AsCustom::no);
}

/// The groups as columns of the closed form of a free body; none where one of them has no closed form.
std::vector<SensitivityTo> find_closed_columns(const Scene& scene, const std::vector<std::string>& groups) {
  static constexpr std::pair<std::string_view, SensitivityTo> closed[] = {{"omega", SensitivityTo::omega},
                                                                          {"attitude", SensitivityTo::attitude},
                                                                          {"inertia", SensitivityTo::inertia},
                                                                          {"axes", SensitivityTo::axes}};
  std::vector<SensitivityTo> columns;
  if (!scene.torques().empty() || !scene.rotors().empty() || scene.changes()) return columns;
  for (const std::string& group : groups) {
    const auto* found = std::find_if(std::begin(closed), std::end(closed), [&](const auto& one) { return one.first == group; });
    if (found == std::end(closed)) return {};
    columns.push_back(found->second);
  }
  return columns;
}

MotionSensitivity differentiate_free(const Scene& scene, const std::vector<SensitivityTo>& columns, RotationSide side) {
  const FreeSensitivity closed(FreeMotion(scene.given_inertia_B(), scene.omega(), scene.attitude()), columns, side);
  const std::size_t n = scene.times().size();
  std::vector<double> t = scene.times();
  for (double& time : t) time -= scene.t0();
  MotionSensitivity found;
  found.omega.resize(3 * n), found.attitude.resize(4 * n);
  found.d_omega.resize(3 * n * closed.columns()), found.d_attitude.resize(3 * n * closed.columns());
  closed.at(t.data(), n, found.omega.data(), found.attitude.data(), found.d_omega.data(), found.d_attitude.data());
  return found;
}

MotionSensitivity integrate_columns(const Scene& given, const std::vector<SceneParameter>& parameters,
                                    const SensitivityOptions& options) {
  const Scene scene = resolve(given, parameters);
  require_formulas(scene);
  const double certain = std::max(options.accuracy, 1e-13);   // of the motion beside columns
  const ColumnRun columns(scene, parameters, options.side, {certain, options.body, options.rescale});
  // The error of a column grows with the turns, as that of a state does.
  const double turns = std::min(std::max(1.0, compute_facts(scene).turns), 1e6);
  double rtol = std::max(0.25 * options.accuracy / turns, least_tolerance / finer);
  MotionSensitivity found;
  if (!options.certify) rtol = std::max(rtol * finer, least_tolerance);
  ColumnSamples last = columns.run(rtol, options.max_steps, options.certify ? samples_compared : 0), now;
  found.runs = 1, found.steps = last.steps;
  double worst = options.certify ? std::numeric_limits<double>::infinity() : 0.0;
  double part = finer;
  for (; found.runs < most_runs && worst > options.accuracy && rtol > least_tolerance; ++found.runs) {
    rtol = std::max(rtol * part, least_tolerance);
    now = columns.run(rtol, options.max_steps, 0);
    found.steps += now.steps;
    found.error = compare(last, now, parameters.size(), find_rate_scale(scene, now.omega));
    worst = 0.0;
    for (const double error : found.error) worst = error <= worst ? worst : error;   // NaN stays
    // The difference of one column may be small by chance.
    for (double& error : found.error) error = margin * std::max(error, unsure * worst);
    worst *= margin;
    part = worst > 0.0 ? std::min(finer, 0.25 * options.accuracy / worst) : finer;
    last = std::move(now);
  }
  for (double& error : found.error) error += rounding * turns + (scene.controllers().empty() ? 0.0 : rounding_of_laws);
  found.omega = std::move(last.omega), found.attitude = std::move(last.attitude);
  found.d_omega = std::move(last.d_omega), found.d_attitude = std::move(last.theta);
  found.d_states = std::move(last.d_states);
  found.scale = std::move(last.scale), found.uncertain = std::move(last.uncertain);
  if (!found.uncertain.empty()) std::fill(found.error.begin(), found.error.end(), std::numeric_limits<double>::infinity());
  if (options.side == RotationSide::space) rotate_to_space(found.attitude, parameters.size(), found.d_attitude);
  return found;
}

}  // namespace

MotionSensitivity compute_sensitivity(const Scene& given, const std::vector<std::string>& groups,
                                      const SensitivityOptions& options) {
  if (!(options.accuracy > 0.0 && options.accuracy <= 1.0))
    throw InvalidInput("accuracy", "above 0 and at most 1", to_text(options.accuracy));
  const std::vector<SceneParameter> parameters = find_all(given, groups);   // resolved torques keep their numbers
  const std::vector<SensitivityTo> closed = find_closed_columns(given, groups);
  MotionSensitivity found = closed.empty() ? integrate_columns(given, parameters, options)
                                           : differentiate_free(given, closed, options.side);
  for (const SceneParameter& parameter : parameters) found.columns.push_back(parameter.column);
  return found;
}

}  // namespace polhode
