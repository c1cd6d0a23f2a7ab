/* polhode for C, and for every language that calls C: closed forms, scenes and their solution. Link with polhode_c.
 *
 * Arrays are double, row by row. Attitudes are quaternions (x, y, z, w) from body to space. Omega and torques are in
 * body axes. SI units. A tensor has nine numbers, those of a symmetric matrix [kg m^2].
 *
 * A function that can fail returns a polhode_status. What it was to write is then not written, and polhode_last_error()
 * says what was wrong. No exception leaves a function. NULL stands for a default only where this file says so.
 *
 * A caller destroys each handle by the function of its type that ends in _destroy. NULL is allowed there. Closed forms
 * and motions do not change: several threads may read one. A scene belongs to one thread while it is filled.
 *
 * Copyright (c) 2026, the polhode developers. SPDX-License-Identifier: BSD-3-Clause */
#ifndef POLHODE_H
#define POLHODE_H

#include <stddef.h>

#if defined(__GNUC__)
#define POLHODE_API __attribute__((visibility("default")))
#else
#define POLHODE_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* Grows where a program compiled against an older header would break. New functions and new fields at the end of a
 * structure leave it as it is. */
#define POLHODE_ABI_VERSION 1
POLHODE_API int polhode_abi_version(void);      /* of the library, to be compared with the number above */
POLHODE_API const char* polhode_version(void);  /* of polhode, "major.minor.patch" */

typedef enum polhode_status {
  POLHODE_OK = 0,
  POLHODE_INVALID_INPUT = 1, /* a value that no computation can start from */
  POLHODE_FAILED = 2,        /* a computation that started well and could not be carried to its end */
  POLHODE_STOPPED = 3,       /* a function of the caller ended the work */
  POLHODE_NO_MEMORY = 4,
  POLHODE_INTERNAL = 5       /* any other exception */
} polhode_status;

/* The sentence of this thread's last call that failed, "" before the first. It is valid until the next one fails. */
POLHODE_API const char* polhode_last_error(void);

/* Structures start with their size. A caller sets it to sizeof, and the other fields of an input to 0 or to values. The
 * library fills the fields of an output that the caller knows. */

/* ---- A free body ------------------------------------------------------------------------------------------------ */

typedef struct polhode_free_motion polhode_free_motion;

typedef struct polhode_free_motion_facts {
  size_t size;
  const char* kind;            /* "rest", "spherical", "steady", "oblate", ..., as in C++; static */
  double period;               /* of omega [s] */
  double precession_rate;      /* mean rate about the angular momentum [rad/s] */
  double energy;               /* [J] */
  double angular_momentum[3];  /* in space [kg m^2/s] */
} polhode_free_motion_facts;

/* attitude may be NULL: the body axes are those of space. */
POLHODE_API polhode_status polhode_free_motion_create(const double inertia[9], const double omega[3],
                                                      const double attitude[4], polhode_free_motion** made);
POLHODE_API void polhode_free_motion_destroy(polhode_free_motion* motion);
/* count states: 3 count numbers of omega, 4 count of attitude; either may be NULL. */
POLHODE_API polhode_status polhode_free_motion_at(const polhode_free_motion* motion, const double* times, size_t count,
                                                  double* omega, double* attitude);
POLHODE_API polhode_status polhode_free_motion_get_facts(const polhode_free_motion* motion,
                                                         polhode_free_motion_facts* facts);
/* The middles of the flips in [begin, end]. count receives their number, times the first `room` of them; times may be
 * NULL where room is 0. */
POLHODE_API polhode_status polhode_free_motion_flip_times(const polhode_free_motion* motion, double begin, double end,
                                                          double* times, size_t room, size_t* count);

/* ---- A free body with rotors ------------------------------------------------------------------------------------ */

typedef struct polhode_gyrostat polhode_gyrostat;

typedef struct polhode_gyrostat_facts {
  size_t size;
  const char* kind;            /* "rest", "steady", "precession", "paired", "single" or "separatrix"; static */
  double period;               /* of omega [s] */
  double energy;               /* without that inside the rotors [J] */
  double angular_momentum[3];  /* of all, in space [kg m^2/s] */
} polhode_gyrostat_facts;

/* momentum: of the rotors, in body axes [kg m^2/s]. attitude may be NULL. */
POLHODE_API polhode_status polhode_gyrostat_create(const double inertia[9], const double momentum[3],
                                                   const double omega[3], const double attitude[4],
                                                   polhode_gyrostat** made);
POLHODE_API void polhode_gyrostat_destroy(polhode_gyrostat* motion);
POLHODE_API polhode_status polhode_gyrostat_at(const polhode_gyrostat* motion, const double* times, size_t count,
                                               double* omega, double* attitude);
POLHODE_API polhode_status polhode_gyrostat_get_facts(const polhode_gyrostat* motion, polhode_gyrostat_facts* facts);

/* ---- Lagrange's top --------------------------------------------------------------------------------------------- */

typedef struct polhode_heavy_top polhode_heavy_top;

typedef struct polhode_heavy_top_facts {
  size_t size;
  const char* kind;        /* "looping", "cuspidal", "monotone", ..., as in C++; static */
  double nutation_period;  /* of the tilt [s] */
  double tilt_min;         /* between body axis and space z [rad] */
  double tilt_max;
  double precession_rate;  /* mean rate about space z [rad/s] */
  double energy;           /* [J] */
  double p_phi;            /* angular momentum about space z [kg m^2/s] */
  double p_psi;            /* the same about the symmetry axis */
} polhode_heavy_top_facts;

/* inertia: about the pivot. weight_arm: mass x gravity x distance of the centre of mass, signed along the axis [N m].
 * rotor: momentum of rotors about the symmetry axis [kg m^2/s]. attitude may be NULL. */
POLHODE_API polhode_status polhode_heavy_top_create(const double inertia[9], double weight_arm, const double omega[3],
                                                    const double attitude[4], double rotor, polhode_heavy_top** made);
POLHODE_API void polhode_heavy_top_destroy(polhode_heavy_top* motion);
POLHODE_API polhode_status polhode_heavy_top_at(const polhode_heavy_top* motion, const double* times, size_t count,
                                                double* omega, double* attitude);
POLHODE_API polhode_status polhode_heavy_top_get_facts(const polhode_heavy_top* motion, polhode_heavy_top_facts* facts);

/* ---- A scene ---------------------------------------------------------------------------------------------------- */

typedef struct polhode_scene polhode_scene;

/* A body with its start at t = 0, without torques and times. attitude may be NULL. */
POLHODE_API polhode_status polhode_scene_create(const double inertia[9], const double omega[3],
                                                const double attitude[4], polhode_scene** made);
POLHODE_API void polhode_scene_destroy(polhode_scene* scene);
POLHODE_API polhode_status polhode_scene_set_start_time(polhode_scene* scene, double t0);
/* Where the answer is wanted, in any order [s]: these in place of those before. */
POLHODE_API polhode_status polhode_scene_set_times(polhode_scene* scene, const double* times, size_t count);

/* Each adds a torque [N m]. */
POLHODE_API polhode_status polhode_scene_add_constant(polhode_scene* scene, const double torque[3], int in_space);
POLHODE_API polhode_status polhode_scene_add_gravity(polhode_scene* scene, double weight, const double arm[3]);
POLHODE_API polhode_status polhode_scene_add_gravity_gradient(polhode_scene* scene, double mean_motion, double phase);
POLHODE_API polhode_status polhode_scene_add_damping(polhode_scene* scene, const double matrix[9]);
/* A formula as in scene files, "-kd * omega", with its parameters by name. names and values may be NULL where count is
 * 0. */
POLHODE_API polhode_status polhode_scene_add_formula(polhode_scene* scene, const char* text, const char* const* names,
                                                     const double* values, size_t count);
/* A function of the caller. It writes three numbers and returns 0; any other number ends the solution with
 * POLHODE_STOPPED. */
typedef int (*polhode_torque_function)(double t, const double omega[3], const double attitude[4], double torque[3],
                                       void* data);
POLHODE_API polhode_status polhode_scene_add_custom(polhode_scene* scene, polhode_torque_function function, void* data);
/* The torque that was added last acts from begin to end only; further calls add further windows [s]. */
POLHODE_API polhode_status polhode_scene_add_window(polhode_scene* scene, double begin, double end);
/* A rotor that a motor holds at its speed: its momentum about an axis of the body [kg m^2/s]. */
POLHODE_API polhode_status polhode_scene_add_rotor(polhode_scene* scene, const double axis[3], double momentum);

/* ---- Its solution ----------------------------------------------------------------------------------------------- */

typedef struct polhode_motion polhode_motion;

typedef struct polhode_solve_options { /* 0 or NULL: not given */
  size_t size;
  double accuracy;        /* of every sample; excludes rtol and atol */
  const char* method;     /* "exact" or the name of a method; the plan chooses where it is NULL */
  double rtol, atol;      /* tolerances of a step */
  double step;            /* [s], of methods with fixed steps */
  long long max_steps;
  int expected_only;      /* the error is expected, not bounded, in half the time */
  int proof;              /* the error is proved */
  int (*stop)(void* data); /* called some twenty times a second; any number but 0 ends the solution */
  void* data;             /* for stop */
} polhode_solve_options;

typedef struct polhode_motion_facts {
  size_t size;
  size_t count;             /* of samples that were reached */
  int success;              /* the end was reached, and no error exceeds the requested accuracy */
  double error;             /* of all samples; NaN where it is not estimated */
  double reached;           /* the time that was reached [s] */
  long long steps;
  const char* error_kind;   /* "bounded", "proved", "expected", ...; as long as the motion, as the next three */
  const char* model;        /* of the plan: "euler", "pieces" or the name of a closed form */
  const char* method;       /* of the plan: "exact" or the name of a method */
  const char* message;      /* how the run ended */
} polhode_motion_facts;

/* options may be NULL. A motion that did not reach its end is made all the same: see success. */
POLHODE_API polhode_status polhode_solve(const polhode_scene* scene, const polhode_solve_options* options,
                                         polhode_motion** made);
POLHODE_API void polhode_motion_destroy(polhode_motion* motion);
POLHODE_API polhode_status polhode_motion_get_facts(const polhode_motion* motion, polhode_motion_facts* facts);
/* Copies the samples: count, 3 count and 4 count numbers; each may be NULL. room: how many samples the arrays hold. */
POLHODE_API polhode_status polhode_motion_get_samples(const polhode_motion* motion, size_t room, double* times,
                                                      double* omega, double* attitude);

#ifdef __cplusplus
}
#endif

#endif
