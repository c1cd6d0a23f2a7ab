// A minimal engine loop with the free step: boxes that tumble in a room, float32, 60 steps a second.
//
//   g++ -std=c++17 -O2 -I<folder of step.hpp> engine.cpp -o engine && ./engine 3600
//
// Contacts are impulses without friction or loss, so the energy of each box should stay. The program prints how far
// the energy is from its start, for the free step and for three steps that engines use. docs/step.md shows a run.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <initializer_list>
#include <vector>

#include "step.hpp"

namespace {

using polhode::step::Inertia;
using Vec = polhode::step::Vec<float>;
using Quat = polhode::step::Quat<float>;

Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec operator*(float s, Vec a) { return {s * a.x, s * a.y, s * a.z}; }
float dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec cross(Vec a, Vec b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
Quat inverse(Quat q) { return {-q.x, -q.y, -q.z, q.w}; }
Vec to_body(Quat q, Vec v) { return polhode::step::rotate_back(q, v); }
Vec to_space(Quat q, Vec v) { return polhode::step::rotate_back(inverse(q), v); }

constexpr float h = 1.0f / 60.0f, gravity = 9.81f, room = 5.0f;   // the room: |x|, |y|, |z| < 5 m

struct Box {
  Vec half, moments;
  float mass;
  Inertia<float> inertia;
  Vec x, v, L;   // L about the centre of mass, in space
  Quat q;        // the box's own axes are principal
};

Vec rates(const Box& b) { return to_space(b.q, polhode::step::rates(b.inertia, to_body(b.q, b.L))); }

double energy(const Box& b) {
  const Vec w = rates(b);
  return 0.5 * b.mass * dot(b.v, b.v) + 0.5 * dot(w, b.L) + b.mass * gravity * (b.x.z + room);
}

Box make_box(unsigned seed) {
  const auto random = [&seed] {
    seed = seed * 1664525u + 1013904223u;
    return static_cast<float>(seed >> 8) / 16777216.0f;
  };
  Box b;
  b.half = {0.1f + 0.4f * random(), 0.1f + 0.4f * random(), 0.1f + 0.4f * random()};
  b.mass = 800.0f * 8 * b.half.x * b.half.y * b.half.z;
  const float x = b.half.x * b.half.x, y = b.half.y * b.half.y, z = b.half.z * b.half.z;
  b.moments = (b.mass / 3) * Vec{y + z, z + x, x + y};
  b.inertia = polhode::step::make_inertia(b.moments.x, b.moments.y, b.moments.z);
  b.x = {0, 0, 0}, b.v = {4 * random() - 2, 4 * random() - 2, 0}, b.q = {0, 0, 0, 1};
  const Vec w{10 * random() - 5, 10 * random() - 5, 10 * random() - 5};
  b.L = {b.moments.x * w.x, b.moments.y * w.y, b.moments.z * w.z};
  return b;
}

/// A corner that has passed a wall and still approaches it gets an impulse that reverses its approach.
void collide(Box& b) {
  for (int corner = 0; corner < 8; ++corner) {
    const Vec r_B{corner & 1 ? b.half.x : -b.half.x, corner & 2 ? b.half.y : -b.half.y,
                  corner & 4 ? b.half.z : -b.half.z};
    const Vec r = to_space(b.q, r_B), p = b.x + r;
    for (int wall = 0; wall < 6; ++wall) {
      const float side = wall % 2 ? -1.0f : 1.0f;
      const Vec n{wall / 2 == 0 ? side : 0, wall / 2 == 1 ? side : 0, wall / 2 == 2 ? side : 0};   // into the room
      const float approach = dot(b.v + cross(rates(b), r), n);
      if (dot(p, n) > -room || approach >= 0) continue;
      const Vec rn = cross(r, n), change = to_space(b.q, polhode::step::rates(b.inertia, to_body(b.q, rn)));
      const float impulse = -2 * approach / (1 / b.mass + dot(rn, change));
      b.v = b.v + (impulse / b.mass) * n;
      polhode::step::kick(b.L, rn, impulse);   // L += r x impulse
    }
  }
}

// ---- ways to rotate a box over h

void rotate_free(Box& b) { polhode::step::drift_space(b.inertia, h, b.L, b.q); }

/// The attitude rotated by the body's rates over h, w_B; then L_B as it comes out, in space.
void rotate_with(Box& b, Vec L_B) {
  const Vec w = polhode::step::rates(b.inertia, L_B);
  const float angle = h * std::sqrt(dot(w, w)), s = angle > 1e-6f ? std::sin(angle / 2) / angle * h : h / 2;
  b.q = polhode::step::compose(b.q, Quat{s * w.x, s * w.y, s * w.z, std::cos(angle / 2)});
  b.L = to_space(b.q, L_B);
}

void rotate_ignoring(Box& b) { rotate_with(b, to_body(b.q, b.L)); }   // omega kept in the body

/// Jolt Physics, MotionProperties::ApplyGyroscopicForceInternal.
void rotate_jolt(Box& b) {
  const Vec L = to_body(b.q, b.L), N = L - h * cross(polhode::step::rates(b.inertia, L), L);
  rotate_with(b, std::sqrt(dot(L, L) / dot(N, N)) * N);
}

/// Catto 2015, GDC, Numerical Methods: one Newton step of implicit Euler, by Cramer's rule.
void rotate_catto(Box& b) {
  const Vec L = to_body(b.q, b.L), w = polhode::step::rates(b.inertia, L), I = b.moments, f = h * cross(w, L);
  const Vec c0{I.x, h * (w.z * I.x - L.z), h * (L.y - w.y * I.x)};
  const Vec c1{h * (L.z - w.z * I.y), I.y, h * (w.x * I.y - L.x)};
  const Vec c2{h * (w.y * I.z - L.y), h * (L.x - w.x * I.z), I.z};   // the columns of the Jacobian
  const float d = dot(c0, cross(c1, c2));
  const Vec dw = (1 / d) * Vec{dot(f, cross(c1, c2)), dot(c0, cross(f, c2)), dot(c0, cross(c1, f))};
  rotate_with(b, L - Vec{I.x * dw.x, I.y * dw.y, I.z * dw.z});
}

}  // namespace

int main(int arguments, char** values) {
  const int seconds = arguments > 1 ? std::atoi(values[1]) : 60;
  constexpr int boxes = 32;
  struct Way {
    const char* name;
    void (*rotate)(Box&);
  };
  std::printf("median and largest |energy / start - 1| of %d boxes\n%8s", boxes, "seconds");
  const Way ways[] = {{"free step", rotate_free},
                      {"jolt", rotate_jolt},
                      {"catto", rotate_catto},
                      {"no gyroscopic term", rotate_ignoring}};
  for (const Way& way : ways) std::printf("  %20s", way.name);
  std::printf("\n");

  std::vector<Box> all[4];
  std::vector<double> start;
  for (unsigned i = 0; i < boxes; ++i) {
    const Box box = make_box(i + 1);
    start.push_back(energy(box));
    for (auto& some : all) some.push_back(box);
  }
  for (int second = 1; second <= seconds; ++second) {
    const bool shown = second == seconds || second % (seconds >= 600 ? 600 : 60) == 0;
    if (shown) std::printf("%8d", second);
    for (int way = 0; way < 4; ++way) {
      double error[boxes];
      for (int i = 0; i < boxes; ++i) {
        Box& b = all[way][i];
        for (int step = 0; step < 60; ++step) {
          b.v.z -= h / 2 * gravity;   // half a kick, the drift, half a kick
          b.x = b.x + h * b.v;
          ways[way].rotate(b);
          b.v.z -= h / 2 * gravity;
          collide(b);
        }
        error[i] = std::fabs(energy(b) / start[i] - 1);
      }
      if (!shown) continue;
      for (int i = 0; i < boxes; ++i)   // sorted by insertion
        for (int k = i; k > 0 && error[k] < error[k - 1]; --k) {
          const double e = error[k];
          error[k] = error[k - 1], error[k - 1] = e;
        }
      std::printf("  %9.1e %10.1e", error[boxes / 2], error[boxes - 1]);
    }
    if (shown) std::printf("\n");
  }
}
