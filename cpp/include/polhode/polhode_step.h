/* polhode/polhode_step.h: polhode/step.hpp for C. Copy both files.
 *
 * One C++17 file of the program compiles the functions:
 *
 *   #define POLHODE_STEP_IMPLEMENTATION
 *   #include "polhode_step.h"
 *
 * Attitudes are quaternions (x, y, z, w) from principal axes to space; moments and L are about the centre of mass or
 * a fixed pivot. Functions end in `f` for float, in `d` for double. Nothing is allocated and nothing fails.
 * Copyright (c) 2026, the polhode developers. SPDX-License-Identifier: BSD-3-Clause. The licence is in step.hpp.
 */
#ifndef POLHODE_STEP_H
#define POLHODE_STEP_H

#ifdef __cplusplus
extern "C" {
#endif

typedef struct { float a[3], scale; } polhode_inertia_f;   /* largest moment over each; 1 / largest moment */
typedef struct { double a[3], scale; } polhode_inertia_d;

/* From principal moments, all positive, in any order. */
polhode_inertia_f polhode_make_inertia_f(const float moments[3]);
polhode_inertia_d polhode_make_inertia_d(const double moments[3]);

/* From a full tensor {xx, yy, zz, xy, xz, yz} in body axes. q_BP: principal axes to body axes. */
polhode_inertia_f polhode_make_principal_f(const float tensor[6], float q_BP[4]);
polhode_inertia_d polhode_make_principal_d(const double tensor[6], double q_BP[4]);

/* The free motion over h: L in principal axes, which changes. */
void polhode_drift_body_f(const polhode_inertia_f* body, float h, float L[3], float q[4]);
void polhode_drift_body_d(const polhode_inertia_d* body, double h, double L[3], double q[4]);

/* The free motion over h: L in space, which does not change. */
void polhode_drift_space_f(const polhode_inertia_f* body, float h, const float L[3], float q[4]);
void polhode_drift_space_d(const polhode_inertia_d* body, double h, const double L[3], double q[4]);

#ifdef __cplusplus
}
#endif

#if defined(__cplusplus) && defined(POLHODE_STEP_IMPLEMENTATION)
#include "step.hpp"

#define POLHODE_STEP_FUNCTIONS(T, end)                                                                     \
  polhode_inertia_##end polhode_make_inertia_##end(const T* I) {                                           \
    const auto b = polhode::step::make_inertia(I[0], I[1], I[2]);                                          \
    return {{b.a[0], b.a[1], b.a[2]}, b.scale};                                                            \
  }                                                                                                        \
  polhode_inertia_##end polhode_make_principal_##end(const T* I, T* q) {                                   \
    const auto p = polhode::step::make_principal(I[0], I[1], I[2], I[3], I[4], I[5]);                      \
    q[0] = p.q_BP.x, q[1] = p.q_BP.y, q[2] = p.q_BP.z, q[3] = p.q_BP.w;                                    \
    return {{p.inertia.a[0], p.inertia.a[1], p.inertia.a[2]}, p.inertia.scale};                            \
  }                                                                                                        \
  void polhode_drift_body_##end(const polhode_inertia_##end* b, T h, T* L, T* q) {                         \
    const polhode::step::Inertia<T> body{{b->a[0], b->a[1], b->a[2]}, b->scale};                           \
    polhode::step::Vec<T> l{L[0], L[1], L[2]};                                                             \
    polhode::step::Quat<T> p{q[0], q[1], q[2], q[3]};                                                      \
    polhode::step::drift_body(body, h, l, p);                                                              \
    L[0] = l.x, L[1] = l.y, L[2] = l.z, q[0] = p.x, q[1] = p.y, q[2] = p.z, q[3] = p.w;                    \
  }                                                                                                        \
  void polhode_drift_space_##end(const polhode_inertia_##end* b, T h, const T* L, T* q) {                  \
    const polhode::step::Inertia<T> body{{b->a[0], b->a[1], b->a[2]}, b->scale};                           \
    polhode::step::Quat<T> p{q[0], q[1], q[2], q[3]};                                                      \
    polhode::step::drift_space(body, h, polhode::step::Vec<T>{L[0], L[1], L[2]}, p);                       \
    q[0] = p.x, q[1] = p.y, q[2] = p.z, q[3] = p.w;                                                        \
  }
POLHODE_STEP_FUNCTIONS(float, f)
POLHODE_STEP_FUNCTIONS(double, d)
#undef POLHODE_STEP_FUNCTIONS
#endif

#endif
