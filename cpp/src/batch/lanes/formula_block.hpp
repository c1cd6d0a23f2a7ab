#pragma once

#include <cstddef>
#include <vector>

#include "batch/lanes/taylor_block.hpp"
#include "polhode/formula/tape.hpp"

namespace polhode {

/// The recurrences of a torque for eight bodies side by side: one formula::Tape whose numbers are one row a body.
struct FormulaCode {
  /// Row n of a slot begins at offset + n * step. A step of 0: only the newest row is kept, for no sum needs the others.
  struct Place {
    std::ptrdiff_t offset = -1, step = 0;
  };
  struct Term {
    Place place;
    std::ptrdiff_t factor;   ///< among the numbers, as all that follows
  };
  struct Sum {
    std::ptrdiff_t constant = 0;
    std::size_t begin = 0, end = 0;   ///< of terms
  };
  struct Line {
    enum class Kind { sum, product, general, copy } kind = Kind::sum;   ///< copy: a state that an operation weighs
    Place out, weighted;          ///< weighted: row n times n, where an operation needs it
    Sum sum;
    Place first, second;          ///< product: its factors, too
    Place a, b;
    std::ptrdiff_t product = 0;   ///< of products
    std::ptrdiff_t start = 0;     ///< general: its constants of the step, of starts
    int operation = 0;            ///< of the tape
    bool divided = false;
  };
  /// The factors of a sum of products.
  struct Product {
    std::ptrdiff_t left, right;
  };
  /// A vector of space seen from the body. A rotating one has its derivative by the angle behind it.
  struct Vector {
    Place place[3];
    std::ptrdiff_t cosine;        ///< of its three numbers
    bool rotates = false, second = false;
    std::ptrdiff_t rate = 0;
  };
  struct Known {
    Place place;
    int index;                    ///< of the tape's waves
  };

  /// @param order  of the series
  FormulaCode(const formula::Tape& tape, bool rotated, int order);

  bool rotated;                   ///< w_B is not w_P
  Place w_P[3], w_B[3], q[4];
  std::vector<Line> lines;
  std::vector<Term> terms;
  std::vector<Product> products;
  std::vector<Vector> vectors;
  std::vector<Known> waves;
  std::vector<Place> time;
  std::vector<Term> constants;    ///< states with the value of `factor`
  Sum torque[3];                  ///< tau_B
  std::size_t size = 0, numbers = 0, starts = 0;
};

/// The numbers of a tape, in the order that FormulaCode has for them.
std::vector<double> list_numbers(const formula::Tape& tape);

/// Eight bodies stepped by the Taylor series of formulas. The state is (w_P, -, q_WB).
struct FormulaBlock : TaylorBlock {
  const FormulaCode* code = nullptr;
  const formula::Tape* tapes[width] = {};   ///< never null
  double* rows = nullptr;                   ///< code->size numbers, aligned to 64 bytes
  double* numbers = nullptr;                ///< one row each
  double* older = nullptr;                  ///< [product][row n, row n + 1][8]
  double* starts = nullptr;                 ///< [general line][alpha, c1, c2][8]
  bool rotors = false;

  alignas(64) Row inverse[3] = {}, axes[3][3] = {}, momentum[3] = {};   ///< 1 / I, R_BP, h_P
};

struct FormulaKernels {
  explicit operator bool() const { return step != nullptr; }
  void (*step)(FormulaBlock& block);
  void (*sample)(const TaylorBlock& block, const double* s, double (*y)[LaneState::width]);
};

FormulaKernels baseline_formula_lanes();
FormulaKernels avx2_formula_lanes();
FormulaKernels avx512_formula_lanes();

}  // namespace polhode
