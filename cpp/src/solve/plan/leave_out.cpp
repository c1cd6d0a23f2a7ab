#include "solve/plan/leave_out.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>

#include "polhode/solve/closed_form.hpp"
#include "solve/effect/bound.hpp"
#include "solve/effect/torque_size.hpp"
#include "solve/ground/formulas.hpp"
#include "solve/ground/options.hpp"
#include "solve/plan/candidates.hpp"

namespace polhode {
namespace {

constexpr double share_of_accuracy = 1.0 / 3.0;
constexpr double crude_share = 1.0 / 30.0;   // of the accuracy: a bound below it need not be sharp

struct Wants {
  bool omega, attitude;
};

/// How long a torque acts between two times, and the time from there to the farther end, as an integral.
struct Acting {
  double time = 0.0, moment = 0.0;
};
Acting find_acting_time(const AnyTorque& torque, double t0, double first, double last) {
  Acting acting;
  const auto add = [&](double begin, double end) {
    // After and before t0; a window across t0 counts for both.
    const auto count = [&](double from, double to, double span) {
      if (!(from < to)) return;
      acting.time += to - from;
      acting.moment += (to - from) * (span - 0.5 * (from + to));
    };
    count(std::max(begin, t0) - t0, std::min(end, last) - t0, last - t0);
    count(t0 - std::min(end, t0), t0 - std::max(begin, first), t0 - first);
  };
  const auto* during = std::get_if<torques::During>(&torque);
  if (during == nullptr) add(first, last);
  else for (const torques::Window& window : during->windows()) add(window.begin, window.end);
  return acting;
}

/// True if the torques at the start alone show that they matter. A bound is at least int b / Jmax on omega and
/// int b (t - s) / Jmax on the attitude: so much do a change along the momentum and the time after it make.
bool clearly_matters(const Scene& scene, const Wants& want, double accuracy) {
  const auto [first, last] = std::minmax_element(scene.times().begin(), scene.times().end());
  const double from = std::min(*first, scene.t0()), to = std::max(*last, scene.t0());
  const double greatest = scene.inertia_B().moments()[2], rate = scene.omega().norm();
  // The size at the start may be larger than that of the whole span.
  constexpr double room = 3.0;
  const double most = room * share_of_accuracy * accuracy * greatest;
  for (const AnyTorque& torque : scene.torques()) {
    const double size = effect::glance_at_size(torque, scene);
    if (size == 0.0) continue;
    const Acting acting = find_acting_time(torque, scene.t0(), from, to);
    if (want.omega && size * acting.time > 2.0 * most * rate) return true;
    if (want.attitude && size * acting.moment > 2.0 * most) return true;
  }
  return false;
}

std::string explain_bound(double omega, double attitude) {
  char text[160];
  std::snprintf(text, sizeof text, "It changes omega by at most %.0e of the largest rate, and the attitude by at most "
                "%.0e rad.", omega, attitude);
  return text;
}

}  // namespace

std::optional<Negligible> find_negligible(const Scene& scene, const SolveOptions& options) {
  if (!options.leave_out || options.proof || is_by_tolerance(options)) return std::nullopt;
  if (!method_is_free(options) && options.method != "exact") return std::nullopt;
  const std::vector<AnyTorque>& torques = scene.torques();
  if (scene.torque_sum().acting == 0 || !scene.rotors().empty() || scene.changes() || calls_custom(scene))
    return std::nullopt;
  const double rate = scene.omega().norm(), accuracy = get_accuracy(options);
  if (!(rate > 0.0)) return std::nullopt;
  const auto& times = scene.times();
  if (std::all_of(times.begin(), times.end(), [&](double t) { return t == scene.t0(); })) return std::nullopt;
  const Wants want{scene.want().omega || !options.events.empty(), scene.want().attitude || !options.events.empty()};
  if (clearly_matters(scene, want, accuracy)) return std::nullopt;
  if (find_closed_form_record(scene, compute_facts(scene)) != nullptr) return std::nullopt;   // nothing is gained

  std::vector<std::size_t> acting;
  for (std::size_t i = 0; i < torques.size(); ++i)
    if (!traits(torques[i]).vanishes) acting.push_back(i);
  const effect::Together found = effect::bound_together(scene, acting, crude_share * accuracy);
  if (!found.all.is_bounded()) return std::nullopt;
  const double error = std::max(want.omega ? found.all.omega / rate : 0.0, want.attitude ? found.all.attitude : 0.0);
  if (!(error <= share_of_accuracy * accuracy)) return std::nullopt;
  Negligible negligible{{}, error};
  for (std::size_t i = 0; i < acting.size(); ++i) {
    const double omega = found.omega[i] / rate, attitude = found.attitude[i];
    negligible.torques.push_back({acting[i], std::string(torque_name(torques[acting[i]])), omega, attitude,
                                  explain_bound(omega, attitude)});
  }
  return negligible;
}

void number_as_given(const Scene& given, std::vector<LeftOut>& records) {
  // Further parts stand behind all given torques, in the order of their formulas.
  std::vector<std::size_t> owners(given.torques().size());
  std::iota(owners.begin(), owners.end(), std::size_t{0});
  for (std::size_t i = 0; i < given.torques().size(); ++i) {
    if (find_formula(given.torques()[i]) == nullptr) continue;
    const Scene alone = resolve_formulas(given.with_torques({given.torques()[i]}), AsCustom::no);
    owners.insert(owners.end(), alone.torques().size() - 1, i);
  }
  std::map<std::size_t, LeftOut> joined;
  for (const LeftOut& one : records) {
    const std::size_t owner = owners.at(one.torque);
    auto [at, is_new] = joined.try_emplace(owner, one);
    LeftOut& record = at->second;
    record.torque = owner, record.name = std::string(torque_name(given.torques()[owner]));
    if (is_new) continue;
    record.omega += one.omega, record.attitude += one.attitude;
    record.reason = explain_bound(record.omega, record.attitude);
  }
  records.clear();
  for (auto& [number, record] : joined) records.push_back(std::move(record));
}

std::string describe(const LeftOut& left) {
  char text[160];
  std::snprintf(text, sizeof text, "%s left out: at most %.0e rad", left.name.c_str(),
                std::max(left.omega, left.attitude));
  return text;
}

}  // namespace polhode
