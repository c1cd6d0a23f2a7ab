#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "polhode/core/simd.hpp"
#include "polhode/formula/tape.hpp"

namespace polhode::formula {

/// Eight numbers from two octets of values, and their factors.
struct alignas(64) Pick {
  /// Whether the numbers are an octet as it stands, or one number eight times. Kernels without AVX-512 use it.
  enum class Move : std::int32_t { any, none, spread };
  std::array<double, 8> factor{};
  std::array<std::int64_t, 8> index{};    ///< 0 to 7: of the first octet, 8 to 15: of the second
  std::array<std::int32_t, 8> offset{};   ///< the same numbers among all values
  std::ptrdiff_t first = 0, second = 0;   ///< where the two octets begin among all values
  std::int32_t mask = 0;                  ///< lanes that are used
  Move move = Move::any;
};

/// A row of picks: of a sum, or of one octet of operands, whose lanes may come from more than two octets.
struct Range {
  std::ptrdiff_t begin = 0, end = 0;
};

/// Eight operations, or eight forms, of one level.
struct Stage {
  enum class Kind : std::int32_t { sum, product, general };
  Kind kind = Kind::sum;
  std::ptrdiff_t octet = 0;    ///< where the values go, of octets
  std::ptrdiff_t store = -1;   ///< the rows of its factors, for operations
  Range first, second;         ///< sum: its terms. product: left and right. general: the terms c1 and c2
  Range left, right;           ///< general: the factors of older
  std::array<int, 8> operations{}, a{}, b{};             ///< general: into the tape; offsets of the operands of values
  alignas(64) std::array<double, 8> constant{};          ///< sum: of row 0
  alignas(64) std::array<double, 8> weighted{}, divided{};   ///< general: 1 where left_j has the factor j, alpha 1 / n
};

/// What a kernel reads. Sums come in the order of their picks.
struct TableParts {
  int states = 0;              ///< octets of state slots, the first ones
  int given = 0;               ///< octets that are returned, the first of these
  int octets = 0;              ///< of values
  int waves = 0, first_wave = 0;   ///< octets with known rows
  int stores = 0;              ///< octets of operations; products first
  int extras = 0, first_extra = 0;   ///< octets of extras
  std::vector<Stage> stages;   ///< by level
  std::vector<Stage> rates;    ///< of the state octets
  std::vector<Pick> picks;
};

/// A tape packed into octets, to be run by kernels for each instruction set.
///
/// State i of the tape is column column_of(i) of a row, so that the rates and the attitude of a body fill one octet:
/// (w_1, w_2, w_3, 0, x, y, z, w).
class Table {
 public:
  explicit Table(Tape tape);

  /// The tape with its terms in the table's order: compute_series() of it has the bits of the table.
  const Tape& tape() const { return tape_; }
  const TableParts& parts() const { return parts_; }

  static int column_of(int state) { return state < 3 ? state : state + 1; }
  int width() const { return 8 * parts_.given; }          ///< columns of a row
  int extra_width() const { return 8 * parts_.extras; }   ///< columns of a row of extras, in their order
  /// Instructions that move numbers between lanes in one row: what the packing keeps small.
  int count_picks() const { return static_cast<int>(parts_.picks.size()); }

  /// A copy with other numbers in place of those of forms, waves and carried vectors; exponents stay.
  template <class Change>
  Table with_constants(const Change& change) const {
    Table other = *this;
    other.tape_.change_constants(change);
    const auto change_all = [&](auto& numbers) {
      for (double& number : numbers) number = change(number);
    };
    for (Stage& stage : other.parts_.stages) change_all(stage.constant);
    for (Stage& stage : other.parts_.rates) change_all(stage.constant);
    for (Pick& pick : other.parts_.picks) change_all(pick.factor);
    return other;
  }

  /// Rounding of a level: fused with AVX2 and AVX-512.
  static Rounding rounding(SimdLevel level) { return level == SimdLevel::baseline ? Rounding::plain : Rounding::fused; }

  /// Numbers of memory that compute_series() needs, for orders up to this one.
  std::size_t workspace_size(int order) const;
  /// Rows 0..order of the states' coefficients in powers of (time - t) / unit.
  /// @param workspace  workspace_size(order) numbers, aligned to 64 bytes
  /// @param extras     order + 1 rows, or null
  void compute_series(SimdLevel level, math::DD t, double unit, const double* y, int order, double* rows,
                      double* extras, double* workspace) const;

  /// Vectors and numbers of ephemerides that the tape uses.
  int count_known() const { return static_cast<int>(known_.size()); }
  /// The largest coefficient in a row of one of them, from the workspace of the last compute_series().
  double compute_known_size(const double* workspace, int row, int which) const;

 private:
  std::vector<std::vector<std::ptrdiff_t>> group_known() const;

  Tape tape_;
  TableParts parts_;
  std::vector<int> start_columns_;
  std::vector<std::ptrdiff_t> wave_columns_;
  std::vector<std::vector<std::ptrdiff_t>> known_;   ///< columns among the waves
};

}  // namespace polhode::formula
