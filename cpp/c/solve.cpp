#include "polhode/solve/solve.hpp"

#include "c/call.hpp"
#include "c/scene.hpp"
#include "polhode/core/interrupt.hpp"

using namespace polhode;

struct polhode_motion {
  Motion motion;
  bool success;
};

namespace {

std::optional<double> given(double number) { return number == 0.0 ? std::nullopt : std::optional(number); }

SolveOptions convert(const polhode_solve_options& in) {
  SolveOptions options;
  options.accuracy = given(in.accuracy);
  if (in.method != nullptr) options.method = in.method;
  options.rtol = given(in.rtol), options.atol = given(in.atol), options.step = given(in.step);
  if (in.max_steps != 0) options.max_steps = static_cast<long>(in.max_steps);
  options.certify = in.expected_only == 0;
  options.proof = in.proof != 0;
  return options;
}

}  // namespace

extern "C" {

polhode_status polhode_solve(const polhode_scene* scene, const polhode_solve_options* options, polhode_motion** made) {
  return c::call(__func__, [&] {
    polhode_motion*& out = c::need(made, "made");
    const polhode_solve_options asked = c::read(options);
    const Scene checked = c::need(scene, "scene").make();
    SolveOptions how = convert(asked);
    std::optional<InterruptGuard> guard;
    if (asked.stop != nullptr) {
      const auto ask = [&asked] {
        if (asked.stop(asked.data) != 0) throw c::Stopped("the function stop ended the solution");
      };
      how.progress = [ask](double /*reached*/, double /*last*/) { return ask(), true; };   // of steps
      guard.emplace(ask);                                                                 // of all other work
    }
    Motion motion = solve(checked, how);
    const bool success = succeeded(checked, motion);
    out = new polhode_motion{std::move(motion), success};
  });
}

void polhode_motion_destroy(polhode_motion* motion) { delete motion; }

polhode_status polhode_motion_get_facts(const polhode_motion* motion, polhode_motion_facts* facts) {
  return c::call(__func__, [&] {
    const auto& [m, success] = c::need(motion, "motion");
    c::fill(facts, {0, m.t.size(), success ? 1 : 0, m.error, m.t_reached, m.stats.steps, m.error_kind.c_str(),
                    m.plan.model.c_str(), m.plan.method.c_str(), m.message.c_str()});
  });
}

polhode_status polhode_motion_get_samples(const polhode_motion* motion, size_t room, double* times, double* omega,
                                          double* attitude) {
  return c::call(__func__, [&] {
    const Motion& m = c::need(motion, "motion").motion;
    if (room < m.t.size()) {
      throw InvalidInput("room", "at least " + std::to_string(m.t.size()) + " samples", std::to_string(room));
    }
    const auto copy = [](const std::vector<double>& from, double* to) {
      if (to != nullptr) std::copy(from.begin(), from.end(), to);
    };
    copy(m.t, times), copy(m.omega, omega), copy(m.attitude, attitude);
  });
}
}
