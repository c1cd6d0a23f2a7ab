#include "solve/run/join_pieces.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <span>

#include "method/samples.hpp"
#include "polhode/core/error.hpp"
#include "solve/ground/custom_check.hpp"
#include "solve/run/perturb.hpp"

namespace polhode {
namespace {

bool is_exact(const Motion& motion) { return motion.plan.method == "exact"; }

/// The sign of an event's function along a chain of pieces. A piece begins with the sign that the piece before it ended
/// with: rounding at a join makes no zero, and hides none.
class FollowedEvent {
 public:
  explicit FollowedEvent(const SceneEvent& event) : event_(&event) {}

  /// The event of the next piece. It outlives neither this object nor the piece.
  SceneEvent begin_piece(double begin) {
    begin_ = farthest_ = begin;
    begin_side_ = side_;
    return {[this](const State& state) { return follow(state); }, event_->direction, event_->terminal};
  }

  /// Whether a jump of the state takes the function through zero, in the event's direction.
  bool is_crossed(const State& after) {
    const int before = side_.value_or(0);
    note(event_->function(after));
    return before != 0 && *side_ != before && (event_->direction == 0 || event_->direction == -before);
  }

  bool terminal() const { return event_->terminal; }

 private:
  void note(double value) { side_ = (value > 0.0) - (value < 0.0); }

  double follow(const State& state) {
    const double value = event_->function(state), distance = std::abs(state.t - begin_);
    if (state.t == begin_ && begin_side_ && !std::isnan(value))
      return *begin_side_ * std::max(std::abs(value), std::numeric_limits<double>::min());
    // Zeros are narrowed down behind the farthest time alone.
    if (state.t == begin_ || distance > std::abs(farthest_ - begin_)) farthest_ = state.t, note(value);
    return value;
  }

  const SceneEvent* event_;
  std::optional<int> side_, begin_side_;   // 0 at an exact zero, which was found
  double begin_ = 0.0, farthest_ = 0.0;
};

/// Runs the pieces of each direction and joins their rows.
class PieceRunner {
 public:
  PieceRunner(const Scene& scene, const SolveOptions& options, const RunPiece& run, bool perturb_joins)
      : scene_(scene), options_(options), run_(run), perturb_joins_(perturb_joins), reached_(scene.times().size(), 0) {
    const Wanted want = scene.want();
    if (want.omega) motion_.omega.resize(3 * reached_.size());
    if (want.attitude) motion_.attitude.resize(4 * reached_.size());
    motion_.start = scene.start();
    motion_.extra.count = scene.count_states();
    motion_.states.resize(states() * reached_.size());
    motion_.t_reached = scene.t0();
    motion_.has_dense = options.dense;
  }

  /// Returns false if a piece did not reach its end.
  bool run_direction(const std::vector<Piece>& pieces, const std::vector<std::size_t>& order, const Wanted& want) {
    State start = scene_.start();
    events_.clear();
    for (const SceneEvent& event : options_.events) events_.emplace_back(event);
    for (FollowedEvent& event : events_) event.begin_piece(start.t).function(start);
    Momentum momentum = find_momentum(scene_, scene_.t0());
    std::size_t next = 0;
    // The zeros of a start that a closed form needs are kept through the pieces before it too.
    const bool keep_zeros = std::any_of(pieces.begin(), pieces.end(), [](const Piece& piece) {
      return piece.form != nullptr && piece.form->needs_zeros;
    });
    for (const Piece& piece : pieces) {
      const bool forward = piece.end >= piece.begin, last = &piece == &pieces.back();
      std::vector<double> times;
      const std::size_t first = next;
      for (; next < order.size(); ++next) {
        const double t = scene_.times()[order[next]];
        if (forward ? t > piece.end : t < piece.end) break;
        times.push_back(t);
      }
      if (!last || times.empty()) times.push_back(piece.end);
      if (const Momentum after = find_momentum(scene_, piece, piece.begin); !(after == momentum)) {
        start.omega += compute_rate_jump(scene_, start.omega, momentum, after);
        if (ends_at_jump(start)) return true;
      }
      momentum = find_momentum(scene_, piece, piece.end);
      const Scene part = make_piece_scene(scene_, piece, start, std::move(times), want);
      if (part.torque_sum().acting > 0) require_true_claims(part);
      Motion motion = run_(part, piece, make_options(piece, pieces.back().end));
      add(motion);
      const Vector3d jump = find_jump(motion, momentum, piece.end);
      place(part, motion, std::span(order).subspan(first, next - first), piece.end, jump);
      const bool finished = motion.status == Status::finished;
      motion_.t_reached = finished ? piece.end : find_reached(motion, piece);
      if (finished && !last) start = get_join(motion, piece.end, want, keep_zeros);
      motion_.status = motion.status;
      motion_.message = finished ? "" : motion.message;
      if (motion.status == Status::max_steps) motion_.message = describe_max_steps();
      bool ended = false;
      if (last && finished && forward) {
        motion.end_jump = jump;
        if (!options_.events.empty() && !jump.isZero(0.0)) {
          State after = get_end(motion, piece.end, want);
          after.omega += jump;
          ended = ends_at_jump(after);
        }
      }
      if (options_.dense) keep_dense(std::move(motion), piece);
      if (ended) return true;
      if (!finished) return motion_.status == Status::event;
      if (!last && wants_to_stop(pieces.back().end)) return false;
    }
    return true;
  }

  Motion finish() {
    drop_unreached(scene_.times(), reached_, motion_);
    return std::move(motion_);
  }

 private:
  std::size_t states() const { return static_cast<std::size_t>(motion_.extra.count); }

  SolveOptions make_options(const Piece& piece, double last) {
    SolveOptions options = options_;
    for (std::size_t i = 0; i < events_.size(); ++i) options.events[i] = events_[i].begin_piece(piece.begin);
    options.max_steps = options_.max_steps - motion_.stats.steps;
    if (options_.progress)
      options.progress = [this, last](double reached, double) { return options_.progress(reached, last); };
    return options;
  }

  void add(const Motion& part) {
    motion_.stats += part.stats;
    motion_.events.insert(motion_.events.end(), part.events.begin(), part.events.end());
    if (!std::isnan(part.error))
      motion_.error = std::isnan(motion_.error) ? part.error : std::max(part.error, motion_.error);
  }

  /// Copies the rows of a piece into the rows of the motion. A sample at the end of a forward piece has the rates after
  /// the jump there, because a window includes its begin.
  void place(const Scene& part, const Motion& motion, std::span<const std::size_t> order, double end,
             const Vector3d& jump) {
    std::size_t row = 0;
    for (std::size_t i = 0; i < order.size() && row < motion.t.size(); ++i) {
      if (motion.t[row] != part.times()[i]) continue;
      if (!motion_.omega.empty()) std::copy_n(motion.omega.data() + 3 * row, 3, motion_.omega.data() + 3 * order[i]);
      if (!motion_.omega.empty() && motion.t[row] == end)
        for (int k = 0; k < 3; ++k) motion_.omega[3 * order[i] + static_cast<std::size_t>(k)] += jump[k];
      if (!motion_.attitude.empty())
        std::copy_n(motion.attitude.data() + 4 * row, 4, motion_.attitude.data() + 4 * order[i]);
      if (states() > 0)
        std::copy_n(motion.states.data() + states() * row, states(), motion_.states.data() + states() * order[i]);
      reached_[order[i]] = 1;
      ++row;
    }
  }

  /// The change of omega at the end of a piece, where the motion has its last row.
  Vector3d find_jump(const Motion& motion, const Momentum& before, double end) const {
    const Momentum after = find_momentum(scene_, end);
    if (after == before || motion.omega.size() < 3) return Vector3d::Zero();
    const double* w = motion.omega.data() + motion.omega.size() - 3;
    return compute_rate_jump(scene_, {w[0], w[1], w[2]}, before, after);
  }

  static double find_reached(const Motion& motion, const Piece& piece) {
    if (!is_exact(motion) || motion.status != Status::stopped) return motion.t_reached;
    return motion.t.empty() ? piece.begin : motion.t.back();
  }

  State get_end(const Motion& motion, double t, const Wanted& want) const {
    const double* w = motion.omega.data() + motion.omega.size() - 3;
    State end{t, {w[0], w[1], w[2]}, scene_.attitude()};
    if (want.attitude) {
      const double* q = motion.attitude.data() + motion.attitude.size() - 4;
      end.attitude = {q[0], q[1], q[2], q[3]};
    }
    if (states() > 0) end.states.assign(motion.states.end() - motion_.extra.count, motion.states.end());
    return end;
  }

  /// The start of the next piece.
  State get_join(const Motion& motion, double t, const Wanted& want, bool keep_zeros) {
    const State end = get_end(motion, t, want);
    ++joins_;
    return perturb_joins_ ? perturb_state(end, is_exact(motion) ? 8.0 : 2.0, joins_, keep_zeros) : end;
  }

  /// Finds the events that a jump of the rates takes through zero.
  /// @return whether a terminal one ended the run
  bool ends_at_jump(const State& after) {
    bool ended = false;
    for (std::size_t i = 0; i < events_.size() && !ended; ++i) {
      if (!events_[i].is_crossed(after)) continue;
      motion_.events.push_back({static_cast<int>(i), after});
      ended = events_[i].terminal();
    }
    if (!ended) return false;
    motion_.status = Status::event;
    motion_.message = "ended by a terminal event at t = " + polhode::to_text(after.t) + " s";
    motion_.t_reached = after.t;
    return true;
  }

  std::string describe_max_steps() const {
    return "gave up after max_steps = " + std::to_string(options_.max_steps) + " steps at t = " +
           polhode::to_text(motion_.t_reached) + " s";
  }

  void keep_dense(Motion motion, const Piece& piece) {
    motion.t_begin = std::min(piece.begin, motion_.t_reached);
    motion.t_reached = std::max(piece.begin, motion_.t_reached);
    motion.t.clear(), motion.omega.clear(), motion.attitude.clear(), motion.states.clear(), motion.events.clear();
    motion_.pieces.push_back(std::make_shared<const Motion>(std::move(motion)));
  }

  /// Calls `progress` between pieces, because closed forms have no steps.
  bool wants_to_stop(double last) {
    if (!options_.progress || (++calls_ & 15) != 0) return false;
    const auto now = std::chrono::steady_clock::now();
    if (now - last_call_ < std::chrono::milliseconds(50)) return false;
    last_call_ = now;
    if (options_.progress(motion_.t_reached, last)) return false;
    motion_.status = Status::stopped;
    motion_.message = "stopped by the progress callback at t = " + polhode::to_text(motion_.t_reached) + " s";
    return true;
  }

  const Scene& scene_;
  const SolveOptions& options_;
  const RunPiece& run_;
  bool perturb_joins_;
  std::vector<unsigned char> reached_;
  Motion motion_;
  std::vector<FollowedEvent> events_;
  int joins_ = 0;
  unsigned calls_ = 0;
  std::chrono::steady_clock::time_point last_call_ = std::chrono::steady_clock::now();
};

}  // namespace

Motion run_pieces(const Scene& scene, const Pieces& pieces, const SolveOptions& options, const RunPiece& run,
                  bool perturb_joins) {
  const Wanted want{true, carries_attitude(scene, pieces, options)};
  PieceRunner runner(scene, options, run, perturb_joins);
  const SampleOrder order(scene.times(), scene.t0());
  if (runner.run_direction(pieces.backward, order.backward, want))
    runner.run_direction(pieces.forward, order.forward, want);
  Motion motion = runner.finish();
  motion.model = "pieces", motion.state = want.attitude ? "omega, attitude" : "omega";
  return motion;
}

}  // namespace polhode
