#pragma once

#include <vector>

// Small dense matrices by rows, for sets of errors. What is approximate here is verified by measure_defect().
namespace polhode::proof {

/// A bound that was computed with rounding to nearest from numbers that are not negative: fewer than 2^20 sums,
/// products and quotients of them are wrong by less than this in all, underflow included while all are below 2^60.
inline double raised(double x) { return x * (1.0 + 0x1p-30) + 0x1p-900; }

/// At least e^x, 0 <= x <= 60.
double exp_above(double x);

/// An approximate inverse of the (n, n) matrix A; empty where elimination breaks down.
std::vector<double> invert(std::vector<double> A, std::size_t n);

/// n nearly orthonormal columns that follow the longest of the m columns of G, (n, m).
std::vector<double> orthonormalize(const std::vector<double>& G, std::size_t n, std::size_t m);

/// At least the largest row sum of |E - A B|; both are (n, n).
double measure_defect(const std::vector<double>& A, const std::vector<double>& B, std::size_t n);

/// How much wider the coordinates B^-1 b may be than |A| |b|, as a part of their largest, where |E - A B| has this
/// size: B^-1 = (E - D)^-1 A with D = E - A B.
inline double widening(double defect) { return raised(defect / (1.0 - defect)); }

}  // namespace polhode::proof
