#pragma once

#include "exact/gyrostat_start.hpp"
#include "exact/lanes/gyrostat_complex.hpp"

// The four invariants e of a gyrostat: the quadratic form of energy less e (|M|^2 - L^2) is singular for them.
// They are the roots of a quartic, found between its poles 1/J_i and never from a general formula.
namespace polhode::POLHODE_ISA::gyrostat {


/// The energy form and the momentum: A = 1/J, g = A h, m the unit vector of M, sg = omega . m / L.
struct Form {
  const exact::GyrostatStart& start;
  DD A[3], g[3], M[3], m[3], L, sg;
  DD apart[3][3];  ///< A_i - A_o
  bool has_rotor[3]; ///< g_i != 0: 1/J_i is a pole

  explicit Form(const exact::GyrostatStart& s) : start(s) {
    DD LL(0.0), along(0.0);
    for (int i = 0; i < 3; ++i) {
      A[i] = DD(1.0) / DD(s.J[i]);
      g[i] = s.h[i] / DD(s.J[i]);
      M[i] = DD(s.J[i]) * s.w[i] + s.h[i];
      has_rotor[i] = s.h[i].hi != 0.0;
      LL = LL + M[i] * M[i];
      for (int o = 0; o < 3; ++o)
        apart[i][o] = math::two_diff(s.J[o], s.J[i]) / math::two_prod(s.J[i], s.J[o]);
    }
    L = root_of(LL);
    if (L.hi == 0.0) return;
    for (int i = 0; i < 3; ++i) m[i] = M[i] / L, along = along + s.w[i] * m[i];
    sg = along / L;
  }
};

/// The reduced polynomial, lowest power first, in mu = e - A_o about a pole o, or in x = e - sg (o = -1).
struct Quartic {
  DD c[7];  ///< with zeros above the degree
  int degree;

  Quartic(const Form& f, int o) {
    DD u[3], b[3];
    for (int i = 0; i < 3; ++i) {
      if (o < 0) {
        b[i] = f.A[i] - f.sg;
        u[i] = (f.start.w[i] - f.sg * f.M[i]) / f.L;
      } else {
        b[i] = f.apart[i][o];
        u[i] = i == o ? -f.g[o] / f.L : (f.start.w[i] - f.A[o] * f.M[i]) / f.L;
      }
    }
    degree = 1;
    for (int i = 0; i < 3; ++i) degree += f.has_rotor[i];
    for (DD& a : c) a = DD(0.0);
    DD rest[5] = {DD(0.0), DD(0.0), DD(0.0), DD(0.0), DD(0.0)};
    int have = 1;  // the degree of `rest`
    for (int i = 0; i < 3; ++i) {
      if (!f.has_rotor[i]) {
        rest[1] = rest[1] + f.m[i] * f.m[i], rest[0] = rest[0] - f.m[i] * f.m[i] * b[i];
        continue;
      }
      DD term[5] = {u[i] * u[i], math::scaled(u[i] * f.m[i], -2.0), f.m[i] * f.m[i], DD(0.0), DD(0.0)};
      int top = 2;
      for (int j = 0; j < 3; ++j)
        if (j != i && f.has_rotor[j]) multiply(term, top++, b[j]);
      for (int k = 0; k <= top; ++k) c[k] = c[k] + term[k];
    }
    for (int j = 0; j < 3; ++j)
      if (f.has_rotor[j]) multiply(rest, have++, b[j]);
    for (int k = 0; k <= degree; ++k) c[k] = c[k] + rest[k];
  }

  /// p (x - root) in place of p.
  static void multiply(DD (&p)[5], int top, DD root) {
    p[top + 1] = p[top];
    for (int k = top; k >= 1; --k) p[k] = p[k - 1] - root * p[k];
    p[0] = -(root * p[0]);
  }

  DD value(DD x, DD* slope) const {
    DD v = c[degree], d(0.0);
    for (int k = degree - 1; k >= 0; --k) d = d * x + v, v = v * x + c[k];
    *slope = d;
    return v;
  }
  DD value(DD x) const {
    DD v = c[degree];
    for (int k = degree - 1; k >= 0; --k) v = v * x + c[k];
    return v;
  }

  /// Three steps of Newton's method.
  DD polished(DD x) const {
    for (int i = 0; i < 3; ++i) {
      DD slope;
      const DD v = value(x, &slope);
      if (v.hi == 0.0 || slope.hi == 0.0) break;
      x = x - v / slope;
    }
    return x;
  }

  /// One step of Bairstow's method for the factor x^2 + u x + v.
  void improve_factor(DD& u, DD& v) const {
    DD b[7], f[7];  // the quotients by the factor and by its square
    for (int k = degree - 2; k >= 0; --k) b[k] = c[k + 2] - u * b[k + 1] - v * b[k + 2];
    for (int k = degree - 4; k >= 0; --k) f[k] = b[k + 2] - u * f[k + 1] - v * f[k + 2];
    const DD r1 = c[1] - u * b[0] - v * b[1], r0 = c[0] - v * b[0];
    const DD g = b[1] - u * f[0] - v * f[1], h = b[0] - v * f[0];
    const DD det = v * squared(g) + h * (h - u * g);
    if (det.hi == 0.0) return;
    u = u + (h * r1 - g * r0) / det;
    v = v + (g * v * r1 - (g * u - h) * r0) / det;
  }

  /// A root between 0 and `end`, where the signs differ: Newton's method, kept in the bracket.
  DD between_0_and(DD end) const {
    const double side = end.hi < 0.0 ? -1.0 : 1.0, at_zero = c[0].hi;
    // No root is nearer to 0 than this.
    double sum = 0.0, power = 1.0;
    for (int k = 1; k <= degree; ++k, power *= side * end.hi) sum += math::abs(c[k].hi) * power;
    double low = math::min(math::abs(at_zero) / sum, math::abs(end.hi)), high = math::abs(end.hi);
    DD x = side * low;
    for (int i = 0; i < 200; ++i) {
      DD slope;
      const DD v = value(x, &slope);
      if (v.hi == 0.0) return x;
      ((v.hi < 0.0) == (at_zero < 0.0) ? low : high) = side * x.hi;
      DD next = x - v / slope;
      const double size = side * next.hi;
      if (!(size >= low && size <= high)) next = DD(side * (high > 4.0 * low ? math::sqrt(low) * math::sqrt(high)
                                                                             : 0.5 * (low + high)));
      const double step = (next - x).hi;
      x = next;
      if (math::abs(step) <= 1e-22 * math::abs(x.hi)) break;
    }
    return polished(x);
  }
};

/// One invariant e: x = e - sg, and mu = e - 1/J of the pole nearest to it.
struct Root {
  DD x, mu;
  int pole;
};

/// e of a less e of b, from the offsets that cancel least.
inline DD difference(const Form& f, const Root& a, const Root& b) {
  if (a.pole == b.pole) {
    const double by_mu = math::max(math::abs(a.mu.hi), math::abs(b.mu.hi));
    const double by_x = math::max(math::abs(a.x.hi), math::abs(b.x.hi));
    return by_mu <= by_x ? a.mu - b.mu : a.x - b.x;
  }
  const double by_x = math::max(math::abs(a.x.hi), math::abs(b.x.hi));
  const double by_mu = math::max(math::max(math::abs(a.mu.hi), math::abs(b.mu.hi)),
                                 math::abs(f.apart[a.pole][b.pole].hi));
  return by_x < by_mu ? a.x - b.x : f.apart[a.pole][b.pole] + (a.mu - b.mu);
}

/// All four, ascending; or two, and the complex pair of x^2 + be x + ga.
struct Roots {
  Root real[4];
  int count = 0;
  bool pair = false;
  DD be, ga, D;       ///< D: the discriminant of the pair
  bool touch = false;  ///< whether D is 0 to the last bits: on a separatrix the pair is a double root

  explicit Roots(const Form& f) {
    const Quartic about_sg(f, -1);
    int poles[3], n = 0;
    double largest = 0.0;
    for (int i = 0; i < 3; ++i) {
      largest = math::max(largest, math::abs((f.A[i] - f.sg).hi));
      if (f.has_rotor[i]) {
        poles[n++] = i;
      } else {
        add({f.A[i] - f.sg, DD(0.0), i});
      }
    }
    for (int k = 1; k < n; ++k)  // ascending 1/J
      for (int j = k; j > 0 && f.apart[poles[j]][poles[j - 1]].hi < 0.0; --j) {
        const int swapped = poles[j];
        poles[j] = poles[j - 1], poles[j - 1] = swapped;
      }
    DD found[2];
    bool small = false;
    for (int k = 0; k + 1 < n; ++k) {
      const int low = poles[k], high = poles[k + 1];
      const DD half = math::scaled(f.apart[high][low], 0.5);
      const Quartic below(f, low);
      const bool upper = (below.value(half).hi < 0.0) == (below.c[0].hi < 0.0);
      const int pole = upper ? high : low;
      const DD mu = upper ? Quartic(f, high).between_0_and(-half) : below.between_0_and(half);
      Root root{(f.A[pole] - f.sg) + mu, mu, pole};
      refine(f, about_sg, root);
      found[k] = root.x;
      small = small || math::abs(root.x.hi) < 0x1p-20 * largest;
      add(root);
    }
    const DD* p = about_sg.c;
    if (n == 0) {
      add(nearest(f, -p[0] / p[1]));
      sort();
      return;
    }
    const DD lead = p[n + 1];
    const DD c1 = p[n] / lead, c2 = p[n - 1] / lead;
    if (n == 1) {
      be = c1, ga = c2;
    } else if (n == 2) {
      const DD c3 = p[0] / lead, bp = -found[0];
      be = c1 - bp;
      ga = small ? c2 - be * bp : c3 / bp;
      if (!small) be = (c2 - ga) / bp;
    } else {
      const DD c3 = p[1] / lead, c4 = p[0] / lead, gp = found[0] * found[1], bp = -(found[0] + found[1]);
      be = c1 - bp;
      ga = small ? c2 - be * bp - gp : c4 / gp;
      if (!small) be = (c3 - ga * bp) / gp;
    }
    for (int i = 0; i < 3 && n > 1; ++i) about_sg.improve_factor(be, ga);
    D = squared(be) - math::scaled(ga, 4.0);
    pair = D.hi < 0.0;
    touch = math::abs(D.hi) <= 0x1p-103 * (squared(be.hi) + 4.0 * math::abs(ga.hi));
    if (!pair) {
      const DD wide = math::scaled(be + (be.hi < 0.0 ? -root_of(D) : root_of(D)), -0.5);
      for (const DD x : {wide, wide.hi == 0.0 ? wide : ga / wide}) {
        Root root = nearest(f, x);
        refine(f, about_sg, root);
        add(root);
      }
    }
    sort();
  }

 private:
  void add(Root root) { real[count++] = root; }
  void sort() {
    for (int k = 1; k < count; ++k)
      for (int j = k; j > 0 && real[j].x < real[j - 1].x; --j) {
        const Root swapped = real[j];
        real[j] = real[j - 1], real[j - 1] = swapped;
      }
  }

  static Root nearest(const Form& f, DD x) {
    Root root{x, DD(0.0), -1};
    for (int i = 0; i < 3; ++i) {
      const DD mu = x - (f.A[i] - f.sg);
      if (root.pole < 0 || math::abs(mu.hi) < math::abs(root.mu.hi)) root.mu = mu, root.pole = i;
    }
    return root;
  }

  /// Newton's method in the smaller of x and mu; the other follows.
  static void refine(const Form& f, const Quartic& about_sg, Root& root) {
    const DD pole = f.A[root.pole] - f.sg;
    if (math::abs(root.x.hi) < math::abs(root.mu.hi)) {
      root.x = about_sg.polished(root.x);
      root.mu = root.x - pole;
    } else {
      root.mu = Quartic(f, root.pole).polished(root.mu);
      root.x = pole + root.mu;
    }
  }
};

}  // namespace polhode::POLHODE_ISA::gyrostat
