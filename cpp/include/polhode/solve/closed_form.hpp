#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "polhode/solve/facts.hpp"

namespace polhode {

class ClosedForm;

/// Why a closed form does not hold for a scene. The words are made only where they are wanted.
struct Refusal {
  bool refused = false;
  std::string why = {};
  explicit operator bool() const { return refused; }
};
enum class Words { no, yes };

/// The record of a closed form, for the planner, the command line and the docs.
struct ClosedFormRecord {
  std::string_view name;
  std::string_view type;      ///< the class that evaluates it: "FreeMotion"
  std::string_view doc;
  std::string_view source;
  /// Costs [s] of one set-up and of one sample, by benchmarks/planner/fit.py.
  double set_up_seconds, sample_seconds;
  /// Steps over short pieces may take less time than its set-ups.
  bool slow_set_up = false;
  /// It holds only while some numbers of the start are exactly 0.
  bool needs_zeros = false;
  Refusal (*refuse)(const Scene& scene, const Facts& facts, Words words);
  /// Made for a scene that it does not refuse.
  std::unique_ptr<const ClosedForm> (*make)(const Scene& scene, const Facts& facts);
  /// The reason for the plan, in one or two sentences.
  std::string (*explain)(const Scene& scene, const Facts& facts);
  /// The closed forms that measure_error() makes from changed inputs, each at the cost of the form itself.
  int (*count_error_set_ups)(const Scene& scene, const Facts& facts);
  /// True for scenes of which a reader expects this form, so that its refusal is the reason for steps.
  bool (*is_near)(const Scene& scene, const Facts& facts) = nullptr;
};

/// The closed form of a scene. Its time counts from the scene's start. Immutable.
class ClosedForm {
 public:
  explicit ClosedForm(const ClosedFormRecord& record) : record_(record) {}
  virtual ~ClosedForm() = default;
  ClosedForm(const ClosedForm&) = delete;
  ClosedForm& operator=(const ClosedForm&) = delete;

  const ClosedFormRecord& record() const { return record_; }
  std::string_view name() const { return record_.name; }

  virtual void at(const double* t, std::size_t n, double* omega, double* attitude) const = 0;
  /// A rate of change [rad/s], for the steps of an event search.
  virtual double rate(const double* omega) const = 0;
  /// Of small swings of a heavy body [rad/s]; 0 for others.
  virtual double swing_frequency() const { return 0.0; }
  /// Of a pendulum, whose motion stays in the plane across this body axis.
  virtual std::optional<Vector3d> swing_axis() const { return std::nullopt; }
  /// A bound on the error at the scene's times, against the exact motion of the same float64 input. It is 20 units of
  /// rounding (docs/exact.md; the largest measured error is 7). To this it adds the effect of rounding in times from
  /// the start, in weight times arm, in a damping matrix, in the rotors' momentum, in the inertia that free rotors
  /// leave, and in the principal axes of a full tensor.
  virtual double measure_error(const Scene& scene, const Facts& facts) const = 0;

 private:
  const ClosedFormRecord& record_;
};

/// A closed form that a class T of exact/ evaluates.
template <class T>
class ClosedFormOf : public ClosedForm {
 public:
  ClosedFormOf(const ClosedFormRecord& record, T motion) : ClosedForm(record), motion_(std::move(motion)) {}
  void at(const double* t, std::size_t n, double* omega, double* attitude) const final {
    motion_.at(t, n, omega, attitude);
  }
  const T& motion() const { return motion_; }

 private:
  T motion_;
};

/// The records of all closed forms, simplest first, in the order of polhode/exact/closed_forms.hpp.
std::span<const ClosedFormRecord* const> closed_forms();

/// The record of the first closed form that holds for a scene; null if none does.
const ClosedFormRecord* find_closed_form_record(const Scene& scene, const Facts& facts);

/// The first closed form that holds for a scene; null if none does.
std::shared_ptr<const ClosedForm> find_closed_form(const Scene& scene, const Facts& facts);

/// Why a scene without closed form has none.
std::string explain_no_closed_form(const Scene& scene, const Facts& facts);

}  // namespace polhode
