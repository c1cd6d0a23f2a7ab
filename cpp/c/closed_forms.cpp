#include <vector>

#include "c/call.hpp"
#include "polhode/exact/free_motion.hpp"
#include "polhode/exact/gyrostat.hpp"
#include "polhode/exact/heavy_top.hpp"

using namespace polhode;

struct polhode_free_motion {
  FreeMotion motion;
};

struct polhode_gyrostat {
  Gyrostat motion;
};

struct polhode_heavy_top {
  HeavyTop motion;
};

extern "C" {

polhode_status polhode_free_motion_create(const double* inertia, const double* omega, const double* attitude,
                                          polhode_free_motion** made) {
  return c::call(__func__, [&] {
    polhode_free_motion*& out = c::need(made, "made");
    out = new polhode_free_motion{
        FreeMotion(c::inertia(inertia), c::vector(omega, "omega"), c::attitude(attitude))};
  });
}

void polhode_free_motion_destroy(polhode_free_motion* motion) { delete motion; }

polhode_status polhode_free_motion_at(const polhode_free_motion* motion, const double* times, size_t count,
                                      double* omega, double* attitude) {
  return c::call(__func__, [&] { c::evaluate(c::need(motion, "motion").motion, times, count, omega, attitude); });
}

polhode_status polhode_free_motion_get_facts(const polhode_free_motion* motion, polhode_free_motion_facts* facts) {
  return c::call(__func__, [&] {
    const FreeMotion& m = c::need(motion, "motion").motion;
    const Vector3d L = m.angular_momentum();
    c::fill(facts, {0, to_text(m.kind()), m.period(), m.precession_rate(), m.energy(), {L[0], L[1], L[2]}});
  });
}

polhode_status polhode_free_motion_flip_times(const polhode_free_motion* motion, double begin, double end,
                                              double* times, size_t room, size_t* count) {
  return c::call(__func__, [&] {
    if (room > 0) c::need(times, "times");
    c::need(count, "count");
    const std::vector<double> found = c::need(motion, "motion").motion.flip_times(begin, end);
    *count = found.size();
    std::copy_n(found.begin(), std::min(room, found.size()), times);
  });
}

polhode_status polhode_gyrostat_create(const double* inertia, const double* momentum, const double* omega,
                                       const double* attitude, polhode_gyrostat** made) {
  return c::call(__func__, [&] {
    polhode_gyrostat*& out = c::need(made, "made");
    out = new polhode_gyrostat{Gyrostat(c::inertia(inertia), c::vector(momentum, "momentum"),
                                                          c::vector(omega, "omega"), c::attitude(attitude))};
  });
}

void polhode_gyrostat_destroy(polhode_gyrostat* motion) { delete motion; }

polhode_status polhode_gyrostat_at(const polhode_gyrostat* motion, const double* times, size_t count, double* omega,
                                   double* attitude) {
  return c::call(__func__, [&] { c::evaluate(c::need(motion, "motion").motion, times, count, omega, attitude); });
}

polhode_status polhode_gyrostat_get_facts(const polhode_gyrostat* motion, polhode_gyrostat_facts* facts) {
  return c::call(__func__, [&] {
    const Gyrostat& m = c::need(motion, "motion").motion;
    const Vector3d L = m.angular_momentum();
    c::fill(facts, {0, to_text(m.kind()), m.period(), m.energy(), {L[0], L[1], L[2]}});
  });
}

polhode_status polhode_heavy_top_create(const double* inertia, double weight_arm, const double* omega,
                                        const double* attitude, double rotor, polhode_heavy_top** made) {
  return c::call(__func__, [&] {
    polhode_heavy_top*& out = c::need(made, "made");
    out = new polhode_heavy_top{
        HeavyTop(c::inertia(inertia), weight_arm, c::vector(omega, "omega"), c::attitude(attitude), rotor)};
  });
}

void polhode_heavy_top_destroy(polhode_heavy_top* motion) { delete motion; }

polhode_status polhode_heavy_top_at(const polhode_heavy_top* motion, const double* times, size_t count, double* omega,
                                    double* attitude) {
  return c::call(__func__, [&] { c::evaluate(c::need(motion, "motion").motion, times, count, omega, attitude); });
}

polhode_status polhode_heavy_top_get_facts(const polhode_heavy_top* motion, polhode_heavy_top_facts* facts) {
  return c::call(__func__, [&] {
    const HeavyTop& m = c::need(motion, "motion").motion;
    c::fill(facts, {0, to_text(m.kind()), m.nutation_period(), m.tilt_min(), m.tilt_max(), m.precession_rate(),
                    m.energy(), m.p_phi(), m.p_psi()});
  });
}
}
