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

/// Numbers with the three errors that a run carries: what its steps have lost, and two samples of rounding.
struct Carried {
  std::vector<double> values;
  std::array<std::vector<double>, 3> errors;

  Carried() = default;
  explicit Carried(std::size_t n) : values(n), errors{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n)} {}
  explicit Carried(const std::vector<double>& start) : Carried(start.size()) { values = start; }
  /// The sum of the errors' sizes.
  double find_error(std::size_t i) const;
  /// Adds an error of known size but unknown sign.
  void widen(std::size_t i, double size);
};

/// The law of a controller, ready to be called. What goes in: omega, attitude, and the numbers of its inputs().
class Update {
 public:
  explicit Update(const Controller& controller);

  std::size_t outputs() const { return outputs_; }

  /// One call. The errors go through the derivative of the branches that are taken. Where a guard is no larger than
  /// four times its error, its branch is not certain, and the jump between both is added.
  /// @param out  one number for each of inputs()
  /// @throws InvalidInput for numbers that are not finite, naming the tick and its time
  void operator()(double t, std::uint64_t tick, const Carried& in, bool with_errors, Carried& out);

 private:
  void call(double t, const double* in, double* out);
  void carry_by_slopes(double t, const Carried& in, Carried& out);
  void carry_by_calls(double t, const Carried& in, Carried& out);
  /// What a guard's other branch changes in each output, near the state.
  void add_jump(double t, const Carried& in, const std::vector<bool>& flipped, const std::vector<double>& towards, Carried& out);

  Controller controller_;
  std::size_t inputs_, outputs_, guards_ = 0;
  std::optional<formula::Program> program_;     ///< outputs, then guards
  std::unique_ptr<formula::Evaluator> values_;
  std::optional<formula::Program> slopes_program_;   ///< the same, then their derivatives by each of by_
  std::unique_ptr<formula::Evaluator> slopes_;
  std::vector<std::size_t> by_;                 ///< the inputs that the law uses
  std::vector<double> row_, results_;           ///< of one call
};

}  // namespace polhode
