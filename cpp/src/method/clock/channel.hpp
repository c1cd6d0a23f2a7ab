#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <vector>

#include "method/clock/update.hpp"
#include "polhode/math/draw.hpp"
#include "polhode/method/trajectory.hpp"
#include "polhode/scene/scene.hpp"

namespace polhode {

/// Times within four units of rounding of each other are one instant.
bool is_same_instant(double a, double b);

/// One controller in a run: its ticks, its memory, and the commands that are on their way. A state of the run is
/// omega and attitude in body axes, and the states of the scene.
class Channel {
 public:
  /// @param body  of many: its number decides the draws of the noise
  Channel(const Scene& scene, std::size_t number, std::uint64_t body, const Carrying& carrying, bool keep_ticks);

  /// The next time at which it measures, or a command begins or ends.
  double next() const;
  /// What happens at an instant, in this order.
  void end_pulse(double t, Carried& state);
  void measure(double t, const Carried& state);
  void begin_commands(double t, Carried& state);
  /// Once and for all: ticks from this time on are not called.
  void stop_at(double t) { end_ = t; }
  /// Multiplies all changes that it carries.
  void scale_changes(double factor);

  const Ticks& ticks() const { return ticks_; }
  std::uint64_t tick() const { return tick_; }
  /// The first tick at which a branch or a rounding is not certain, beside columns.
  const std::optional<std::uint64_t>& uncertain() const { return uncertain_; }

 private:
  /// The noise of one quantity.
  struct Noise {
    std::uint64_t key;
    Draw draw;
  };
  struct Pending {
    double t;
    Carried command;
  };

  void fill_inputs(double t, const Carried& state, Carried& in) const;
  void add_noise(Carried& in) const;
  void round(Carried& in);
  void clip(Carried& command);
  void hold(const Carried& command, Carried& state);
  void call(double t, const Carried& in, Carried& out);
  void record(double t, const Carried& command);
  void doubt() { if (!uncertain_) uncertain_ = tick_; }
  bool carries_errors() const { return carrying_.what == Carry::errors; }
  bool carries_columns() const { return carrying_.what == Carry::columns; }
  static void scale(Carried& one, double factor);
  double next_tick() const { return controller_.tick(tick_); }
  std::size_t place(std::string_view name) const;   ///< among the numbers of the inputs, behind omega and attitude
  std::optional<Noise> make_noise(const char* quantity, Distribution distribution, double size) const;

  const Scene& scene_;
  const Controller& controller_;
  std::size_t number_;
  std::uint64_t body_;
  Carrying carrying_;
  bool keep_ticks_;
  Update update_;
  std::uint64_t tick_ = 0;
  double off_ = std::numeric_limits<double>::infinity(), end_ = std::numeric_limits<double>::infinity();
  std::deque<Pending> pending_;
  Carried memory_;                       ///< the numbers of the inputs
  std::size_t field_ = 0, speed_ = 0;    ///< their places, where they are measured
  std::optional<Noise> omega_noise_, attitude_noise_, field_noise_;
  std::vector<std::size_t> held_;        ///< where a command's numbers are in a state of the run
  std::size_t states_;                   ///< numbers of the controller's own
  std::vector<Carried> spare_;           ///< commands that have begun
  Carried in_, out_, zero_;
  Ticks ticks_;
  std::optional<std::uint64_t> uncertain_;
};

}  // namespace polhode
