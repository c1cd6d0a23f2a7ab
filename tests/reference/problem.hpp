/// One turning body in 113-bit arithmetic, as the two reference integrators read it from standard input.
/// Numbers are hexadecimal floats (exact) or decimals of 40 digits; the text comes from make_references.py.
#pragma once

#include <quadmath.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

using Real = __float128;
using Vector = std::array<Real, 3>;

inline Real read_real(std::istream& in) {
  std::string word;
  if (!(in >> word)) std::exit((std::fputs("a number is missing\n", stderr), 1));
  char* end = nullptr;
  const Real value = strtoflt128(word.c_str(), &end);
  if (*end != '\0') std::exit((std::fprintf(stderr, "not a number: %s\n", word.c_str()), 1));
  return value;
}

inline Vector read_vector(std::istream& in) {
  Vector v;
  for (Real& x : v) x = read_real(in);
  return v;
}

/// Principal moments I, rates w [rad/s] in body axes, attitude q = (x, y, z, w) body to space, and the torques of
/// the scenes: -weight g at the arm (g = R^T e_z), 3 n^2 u x (I u), a constant, -C w. Rotors have the momentum h
/// relative to the body, and act by h x w.
struct Problem {
  Vector moments{}, omega{}, arm{}, constant{}, rotors{};
  std::array<Real, 4> attitude{0, 0, 0, 1};
  std::array<Vector, 3> damping{};
  Real weight = 0, mean_motion = 0, phase = 0;
  bool is_stiff = false;
  std::vector<Real> options;  ///< what the method is told: order and so on
  std::vector<Real> times;

  static Problem read(std::istream& in) {
    Problem p;
    for (std::string key; in >> key;) {
      if (key == "moments") p.moments = read_vector(in);
      else if (key == "omega") p.omega = read_vector(in);
      else if (key == "attitude") for (Real& x : p.attitude) x = read_real(in);
      else if (key == "gravity") p.weight = read_real(in), p.arm = read_vector(in);
      else if (key == "gravity_gradient") p.mean_motion = read_real(in), p.phase = read_real(in);
      else if (key == "constant") p.constant = read_vector(in);
      else if (key == "rotors") p.rotors = read_vector(in);
      else if (key == "damping") for (Vector& row : p.damping) row = read_vector(in);
      else if (key == "options" || key == "times") {
        std::size_t count = 0;
        in >> count;
        auto& list = key == "times" ? p.times : p.options;
        for (std::size_t i = 0; i < count; ++i) list.push_back(read_real(in));
      } else std::exit((std::fprintf(stderr, "unknown key: %s\n", key.c_str()), 1));
    }
    return p;
  }
};

inline void print_line(const Real* values, int count) {
  char text[64];
  for (int i = 0; i < count; ++i) {
    quadmath_snprintf(text, sizeof text, "%.36Qe", values[i]);
    std::fputs(text, stdout);
    std::fputc(i + 1 < count ? ' ' : '\n', stdout);
  }
}
