/* What C alone can show: the header is C, sizes of structures, refusals, errors of threads, a table of bits.
 * tests/python/api/test_c_interface.py compares each line of standard output. */
#include <polhode/polhode.h>

#include <math.h>
#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

static const double inertia[9] = {0.2, 0, 0, 0, 0.4, 0, 0, 0, 0.52}, top[9] = {0.4, 0, 0, 0, 0.4, 0, 0, 0, 0.25};
static const double omega[3] = {0.01, 5, 0.01}, attitude[4] = {0.5, -0.5, 0.5, 0.5}, momentum[3] = {0.03, -0.02, 0.05};
static const double times[3] = {0, 1.25, -1e6};

static int failures = 0;

static void expect(int holds, const char* what) {
  if (!holds) ++failures, printf("FAILED %s: %s\n", what, polhode_last_error());
}

static void print_bits(const char* name, const double* numbers, size_t count) {
  printf("%s", name);
  for (size_t i = 0; i < count; ++i) {
    uint64_t bits;
    memcpy(&bits, numbers + i, sizeof bits);
    printf(" %016llx", (unsigned long long)bits);
  }
  printf("\n");
}

static void table_of_bits(void) {
  double w[9], q[12];
  polhode_free_motion* body;
  polhode_gyrostat* gyrostat;
  polhode_heavy_top* heavy;
  expect(polhode_free_motion_create(inertia, omega, attitude, &body) == POLHODE_OK, "free motion");
  expect(polhode_free_motion_at(body, times, 3, w, q) == POLHODE_OK, "free motion at");
  print_bits("free_motion", w, 9), print_bits("free_motion", q, 12);
  polhode_free_motion_destroy(body);
  expect(polhode_gyrostat_create(inertia, momentum, omega, attitude, &gyrostat) == POLHODE_OK, "gyrostat");
  expect(polhode_gyrostat_at(gyrostat, times, 3, w, q) == POLHODE_OK, "gyrostat at");
  print_bits("gyrostat", w, 9), print_bits("gyrostat", q, 12);
  polhode_gyrostat_destroy(gyrostat);
  expect(polhode_heavy_top_create(top, 1.5, omega, attitude, 0.25, &heavy) == POLHODE_OK, "heavy top");
  expect(polhode_heavy_top_at(heavy, times, 3, w, q) == POLHODE_OK, "heavy top at");
  print_bits("heavy_top", w, 9), print_bits("heavy_top", q, 12);
  polhode_heavy_top_destroy(heavy);
}

/* A program of an older header knows fewer fields, one of a newer header more. */
static void sizes(void) {
  polhode_free_motion* body;
  struct { polhode_free_motion_facts facts; double more; } newer = {.more = 7};
  struct { polhode_solve_options options; double more; } asked = {.options = {.size = sizeof asked}};
  const size_t known = offsetof(polhode_free_motion_facts, precession_rate);
  polhode_free_motion_facts older = {.size = known, .precession_rate = 7};
  polhode_scene* scene;
  polhode_motion* motion;
  expect(polhode_free_motion_create(inertia, omega, NULL, &body) == POLHODE_OK, "free motion");
  expect(polhode_free_motion_get_facts(body, &older) == POLHODE_OK, "facts of an older header");
  expect(older.period > 0 && older.precession_rate == 7, "the fields beyond the size are left");
  expect(older.size == known, "the size is left");
  newer.facts.size = sizeof newer;
  expect(polhode_free_motion_get_facts(body, &newer.facts) == POLHODE_OK && newer.more == 7, "facts of a newer header");
  newer.facts.size = 0;
  expect(polhode_free_motion_get_facts(body, &newer.facts) == POLHODE_INVALID_INPUT, "no size");
  polhode_free_motion_destroy(body);

  expect(polhode_scene_create(inertia, omega, NULL, &scene) == POLHODE_OK, "scene");
  expect(polhode_scene_set_times(scene, times, 2) == POLHODE_OK, "times");
  expect(polhode_solve(scene, &asked.options, &motion) == POLHODE_OK, "options of a newer header, not used");
  polhode_motion_destroy(motion);
  asked.more = 1e-9;
  expect(polhode_solve(scene, &asked.options, &motion) == POLHODE_INVALID_INPUT, "options of a newer header, used");
  printf("%s\n", polhode_last_error());
  polhode_scene_destroy(scene);
}

static void refusals(void) {
  const double bad[3] = {1, 2, NAN};
  polhode_free_motion* body = NULL;
  double q[4];
  expect(polhode_free_motion_create(inertia, bad, NULL, &body) == POLHODE_INVALID_INPUT && !body, "omega of NaN");
  printf("%s\n", polhode_last_error());
  expect(polhode_free_motion_create(NULL, omega, NULL, &body) == POLHODE_INVALID_INPUT && !body, "no inertia");
  printf("%s\n", polhode_last_error());
  expect(polhode_free_motion_create(inertia, omega, NULL, NULL) == POLHODE_INVALID_INPUT, "nowhere to write");
  expect(polhode_free_motion_at(NULL, times, 1, NULL, q) == POLHODE_INVALID_INPUT, "no motion");
  printf("%s\n", polhode_last_error());
  expect(polhode_scene_add_gravity(NULL, 1, omega) == POLHODE_INVALID_INPUT, "no scene");
  polhode_free_motion_destroy(NULL), polhode_gyrostat_destroy(NULL), polhode_heavy_top_destroy(NULL);
  polhode_scene_destroy(NULL), polhode_motion_destroy(NULL);
}

static void* other_thread(void* out) {
  polhode_scene* scene;
  expect(polhode_last_error()[0] == '\0', "a new thread has no error");
  expect(polhode_scene_create(NULL, omega, NULL, &scene) == POLHODE_INVALID_INPUT, "a failure of another thread");
  strncpy(out, polhode_last_error(), 99);
  return NULL;
}

static void threads(void) {
  pthread_t thread;
  char mine[100], theirs[100] = "";
  polhode_gyrostat* gyrostat;
  expect(polhode_gyrostat_create(NULL, omega, omega, NULL, &gyrostat) == POLHODE_INVALID_INPUT, "a failure here");
  strncpy(mine, polhode_last_error(), 99);
  pthread_create(&thread, NULL, other_thread, theirs);
  pthread_join(thread, NULL);
  expect(strcmp(mine, polhode_last_error()) == 0 && strcmp(mine, theirs) != 0, "each thread has its own error");
}

int main(void) {
  expect(polhode_abi_version() == POLHODE_ABI_VERSION, "ABI version");
  printf("%s\n", polhode_version());
  table_of_bits();
  sizes();
  refusals();
  threads();
  return failures != 0;
}
