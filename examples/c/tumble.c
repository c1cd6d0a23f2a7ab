/* A thrown block and a heavy body, from C. The header is plain C; the library is the target polhode_c.
 *
 *   cmake -S . -B build -DPOLHODE_BUILD_C=ON && cmake --build build && cmake --install build --prefix /opt/polhode
 *   cc tumble.c -I/opt/polhode/include -L/opt/polhode/lib -Wl,-rpath,/opt/polhode/lib -lpolhode_c -lm -o tumble */
#include <polhode/polhode.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Ends the program with the sentence of the call that failed. */
static void need(polhode_status status) {
  if (status != POLHODE_OK) {
    fprintf(stderr, "%s\n", polhode_last_error());
    exit(1);
  }
}

/* flips */
static void throw_a_block(void) {
  const double inertia[9] = {0.2, 0, 0, 0, 0.4, 0, 0, 0, 0.52}; /* kg m^2 */
  const double omega[3] = {0.01, 5, 0.01};                      /* rad/s, body axes */
  polhode_free_motion* block;
  polhode_free_motion_facts facts = {.size = sizeof facts};
  double times[16], later = 1e6, q[4];
  size_t count, i;

  need(polhode_free_motion_create(inertia, omega, NULL, &block));
  need(polhode_free_motion_get_facts(block, &facts));
  need(polhode_free_motion_flip_times(block, 0, 15, times, 16, &count));
  printf("%s, period %.6f s, flips at", facts.kind, facts.period);
  for (i = 0; i < count; ++i) printf(" %.6f", times[i]);
  need(polhode_free_motion_at(block, &later, 1, NULL, q));
  printf("\nafter 1e6 s: %.9f %.9f %.9f %.9f\n", q[0], q[1], q[2], q[3]);
  polhode_free_motion_destroy(block);
}

/* own torque */
static int brake(double t, const double omega[3], const double attitude[4], double torque[3], void* data) {
  (void)t, (void)attitude;
  torque[0] = torque[1] = 0;
  torque[2] = -*(const double*)data * omega[2]; /* N m, body axes */
  return 0;
}

/* scene */
static void follow_a_scene(void) {
  const double inertia[9] = {1, 0, 0, 0, 1.5, 0, 0, 0, 2}, omega[3] = {0, 0, 3}, times[2] = {2, 4};
  double friction = 0.5, w[6];
  polhode_scene* scene;
  polhode_motion* motion;
  polhode_motion_facts facts = {.size = sizeof facts};
  polhode_solve_options options = {.size = sizeof options, .accuracy = 1e-9};

  need(polhode_scene_create(inertia, omega, NULL, &scene));
  need(polhode_scene_set_times(scene, times, 2));
  need(polhode_scene_add_custom(scene, brake, &friction));
  need(polhode_solve(scene, &options, &motion));
  need(polhode_motion_get_facts(motion, &facts));
  need(polhode_motion_get_samples(motion, 2, NULL, w, NULL));
  printf("%s, %s: omega_z %.8f rad/s at 4 s, by hand %.8f\n", facts.method, facts.error_kind, w[5], 3 * exp(-1.0));
  polhode_motion_destroy(motion);
  polhode_scene_destroy(scene);
}

/* main */
int main(void) {
  if (polhode_abi_version() != POLHODE_ABI_VERSION) return 1;
  throw_a_block();
  follow_a_scene();
  return 0;
}
