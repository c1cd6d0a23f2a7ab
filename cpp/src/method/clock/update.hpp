#pragma once

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "polhode/clock/controller.hpp"

namespace polhode {

inline constexpr double rounding_unit = std::numeric_limits<double>::epsilon();
/// Times the error of a number: beyond it, its side of an edge is certain, and so is the branch of a guard.
inline constexpr double certain_errors = 4.0;

/// What a run carries beside its numbers.
enum class Carry {
  nothing,
  errors,    ///< three: what its steps have lost, and two samples of rounding
  columns    ///< derivatives by numbers of the scene
};

/// Numbers with the small changes of them that a run carries.
struct Carried {
  std::vector<double> values;
  std::vector<std::vector<double>> changes;

  Carried() = default;
  Carried(std::size_t n, std::size_t count) : values(n), changes(count, std::vector<double>(n)) {}
  Carried(const std::vector<double>& start, std::size_t count) : Carried(start.size(), count) { values = start; }
  /// The sum of the sizes of three errors.
  double find_error(std::size_t i) const;
  /// Adds an error of known size but unknown sign to three errors.
  void widen(std::size_t i, double size);
};

/// A column of derivatives that is by a number of the law's parameters.
struct ParameterColumn {
  std::size_t column;
  int number;
};

/// What a controller does with the changes that a run carries.
struct Carrying {
  Carry what = Carry::nothing;
  std::size_t count = 0;
  std::vector<ParameterColumn> by = {};   ///< columns by parameters of its law
  std::vector<ParameterColumn> by_start = {};   ///< columns by the starts of its states, whose numbers these are
  double accuracy = 0.0;                  ///< of the numbers beside columns, which decides what branch is certain
};

/// The law of a controller, ready to be called. What goes in: omega, attitude, and the numbers of its inputs().
class Update {
 public:
  Update(const Controller& controller, Carrying carrying);

  std::size_t outputs() const { return outputs_; }

  /// One call. The changes go through the derivative of the branches that are taken. Where a guard is no larger than
  /// four times its error, its branch is not certain, and the jump between both is added to errors.
  /// @param out  one number for each of inputs()
  /// @throws InvalidInput for numbers that are not finite, naming the tick and its time
  void operator()(double t, std::uint64_t tick, const Carried& in, Carry carry, Carried& out);
  /// Whether all branches of the last call with columns are certain.
  bool is_certain() const { return certain_; }

 private:
  void call(double t, const double* in, double* out);
  void carry_by_slopes(double t, const Carried& in, Carried& out);
  void carry_by_calls(double t, const Carried& in, Carried& out);
  /// What a guard's other branch changes in each output, near the state.
  void add_jump(double t, const Carried& in, const std::vector<bool>& flipped, const std::vector<double>& towards, Carried& out);

  void carry_guards(double t, const Carried& in, Carried& out);
  bool are_certain(const Carried& in);
  /// The derivative of an output or a guard by one of by_, then by the parameters.
  double slope(std::size_t row, std::size_t k) const { return results_[(outputs_ + guards_) * (1 + k) + row]; }
  /// What the changes of the inputs make of an output or a guard, into moved_.
  void move(std::size_t row, const Carried& in);

  Controller controller_;
  Carrying carrying_;
  std::size_t inputs_, outputs_, guards_ = 0;
  std::optional<formula::Program> program_;     ///< outputs, then guards
  std::unique_ptr<formula::Evaluator> values_;
  std::optional<formula::Program> slopes_program_;   ///< the same, then their derivatives by each of by_
  std::unique_ptr<formula::Evaluator> slopes_;
  std::vector<std::size_t> by_;                 ///< the inputs that the law uses
  std::vector<double> row_, results_, moved_;   ///< of one call
  bool certain_ = true;
};

}  // namespace polhode
