#pragma once

// Elementary functions with the same bits on every machine: what no standard fixes, the system's mathematical library
// decides, and it differs between systems and processors. These use only + - * / and sqrt, which IEEE 754 fixes. They
// are compiled once, without contraction, so that callers built for different instruction sets get the same bits too.
// Special values are those of C.
namespace polhode::math {

// Within 0.51 ulp for every argument, at about the speed of the system's library.

struct SinCosPair {
  double sin, cos;
};

SinCosPair sincos(double angle);
double sin(double angle);
double cos(double angle);
double atan2(double y, double x);   ///< 0.51 ulp of the normal numbers; one rounding more below them
double atan(double x);
double asin(double x);
double acos(double x);
double hypot(double a, double b);
double hypot(double a, double b, double c);

// Within 0.51 ulp for every argument, at some 100 to 600 ns: for set-ups and plans.

double exp(double x);
double expm1(double x);
double log(double x);
double asinh(double x);
double cbrt(double x);
double pow(double x, double y);

// Relative error about 1e-15 (of a power x^y: 1e-15 (1 + |y log2 x|)): for step sizes, forecasts and plans.

double fast_log2(double x);
double fast_exp2(double x);
double fast_log(double x);
double fast_pow(double x, double y);    ///< for x > 0
double power(double x, int n);          ///< x^n by repeated multiplication, 0^0 = 1

}  // namespace polhode::math
