#include "solve/pieces.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include "polhode/core/error.hpp"
#include "solve/answered.hpp"
#include "solve/itinerary.hpp"
#include "solve/perturb.hpp"
#include "solve/spot_check.hpp"

namespace polhode {
namespace {

using torques::During;

const During* find_windows(const AnyTorque& torque) {
  const auto* during = std::get_if<During>(&torque);
  return during != nullptr && !during->traits().vanishes ? during : nullptr;
}

AnyTorque drop_window(const AnyTorque& torque) {
  const auto* during = std::get_if<During>(&torque);
  return during == nullptr ? torque : std::visit([](const auto& one) { return AnyTorque(one); }, during->torque());
}

/// The first and the last of the times, the start among them.
std::pair<double, double> find_span(const Scene& scene) {
  const auto [least, most] = std::minmax_element(scene.times().begin(), scene.times().end());
  return {std::min(scene.t0(), *least), std::max(scene.t0(), *most)};
}

/// The torques that act between two times, without their windows.
std::vector<AnyTorque> find_acting(const Scene& scene, double begin, double end) {
  std::vector<AnyTorque> acting;
  for (const AnyTorque& torque : scene.torques()) {
    const auto* during = std::get_if<During>(&torque);
    if (during != nullptr && !(begin < end ? during->acts_throughout(begin, end) : during->acts_at(begin))) continue;
    acting.push_back(drop_window(torque));
  }
  return acting;
}

bool is_exact(const Motion& motion) { return motion.plan.method == "exact"; }

/// The rows of the joined motion, and what all pieces of one direction share.
class Chain {
 public:
  Chain(const Scene& scene, const SolveOptions& options, const RunPiece& run, bool shaken)
      : scene_(scene), options_(options), run_(run), shaken_(shaken), answered_(scene.times().size(), 0) {
    const Wanted want = scene.want();
    if (want.omega) motion_.omega.resize(3 * answered_.size());
    if (want.attitude) motion_.attitude.resize(4 * answered_.size());
    motion_.start = scene.start();
    motion_.t_reached = scene.t0();
    motion_.has_dense = options.dense;
  }

  /// False when a piece did not arrive.
  bool follow(const std::vector<Piece>& pieces, const std::vector<std::size_t>& order, const Wanted& want) {
    State start = scene_.start();
    std::size_t next = 0;
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
      const Scene one = make_piece_scene(scene_, piece, start, std::move(times), want);
      if (one.torque_sum().acting > 0) require_true_claims(one);
      Motion motion = run_(one, make_options(pieces.back().end));
      add(motion);
      place(one, motion, std::span(order).subspan(first, next - first));
      const bool arrived = motion.status == Status::finished;
      motion_.t_reached = arrived ? piece.end : find_reached(motion, piece);
      if (arrived && !last) start = get_end(motion, piece.end, want);
      motion_.status = motion.status;
      motion_.message = arrived ? "" : motion.message;
      if (motion.status == Status::max_steps) motion_.message = describe_max_steps();
      if (options_.dense) keep_dense(std::move(motion), piece);
      if (!arrived) return motion_.status == Status::event;
      if (!last && wants_to_stop(pieces.back().end)) return false;
    }
    return true;
  }

  Motion finish() {
    keep_answered(scene_.times(), answered_, motion_);
    return std::move(motion_);
  }

 private:
  SolveOptions make_options(double last) const {
    SolveOptions one = options_;
    one.max_steps = options_.max_steps - motion_.stats.steps;
    if (options_.progress)
      one.progress = [this, last](double reached, double) { return options_.progress(reached, last); };
    return one;
  }

  void add(const Motion& one) {
    motion_.stats += one.stats;
    motion_.events.insert(motion_.events.end(), one.events.begin(), one.events.end());
    if (!std::isnan(one.error))
      motion_.error = std::isnan(motion_.error) ? one.error : std::max(one.error, motion_.error);
  }

  /// The piece's rows into their places; those that were not reached are not among them.
  void place(const Scene& one, const Motion& motion, std::span<const std::size_t> order) {
    std::size_t row = 0;
    for (std::size_t i = 0; i < order.size() && row < motion.t.size(); ++i) {
      if (motion.t[row] != one.times()[i]) continue;
      if (!motion_.omega.empty()) std::copy_n(motion.omega.data() + 3 * row, 3, motion_.omega.data() + 3 * order[i]);
      if (!motion_.attitude.empty())
        std::copy_n(motion.attitude.data() + 4 * row, 4, motion_.attitude.data() + 4 * order[i]);
      answered_[order[i]] = 1;
      ++row;
    }
  }

  static double find_reached(const Motion& motion, const Piece& piece) {
    if (!is_exact(motion) || motion.status != Status::stopped) return motion.t_reached;
    return motion.t.empty() ? piece.begin : motion.t.back();
  }

  State get_end(const Motion& motion, double t, const Wanted& want) {
    const double* w = motion.omega.data() + motion.omega.size() - 3;
    State end{t, {w[0], w[1], w[2]}, scene_.attitude()};
    if (want.attitude) {
      const double* q = motion.attitude.data() + motion.attitude.size() - 4;
      end.attitude = {q[0], q[1], q[2], q[3]};
    }
    ++joints_;
    return shaken_ ? shake(end, is_exact(motion) ? 8.0 : 2.0, joints_) : end;
  }

  std::string describe_max_steps() const {
    return "gave up after max_steps = " + std::to_string(options_.max_steps) + " steps at t = " +
           polhode::to_text(motion_.t_reached) + " s";
  }

  void keep_dense(Motion motion, const Piece& piece) {
    motion.t_begin = std::min(piece.begin, motion_.t_reached);
    motion.t_reached = std::max(piece.begin, motion_.t_reached);
    motion.t.clear(), motion.omega.clear(), motion.attitude.clear(), motion.events.clear();
    motion_.pieces.push_back(std::make_shared<const Motion>(std::move(motion)));
  }

  /// Closed forms have no steps between which to ask.
  bool wants_to_stop(double last) {
    if (!options_.progress || (++asked_ & 15) != 0) return false;
    const auto now = std::chrono::steady_clock::now();
    if (now - told_ < std::chrono::milliseconds(50)) return false;
    told_ = now;
    if (options_.progress(motion_.t_reached, last)) return false;
    motion_.status = Status::stopped;
    motion_.message = "stopped by the progress callback at t = " + polhode::to_text(motion_.t_reached) + " s";
    return true;
  }

  const Scene& scene_;
  const SolveOptions& options_;
  const RunPiece& run_;
  bool shaken_;
  std::vector<unsigned char> answered_;
  Motion motion_;
  int joints_ = 0;
  unsigned asked_ = 0;
  std::chrono::steady_clock::time_point told_ = std::chrono::steady_clock::now();
};

}  // namespace

bool has_windows(const Scene& scene) {
  return std::any_of(scene.torques().begin(), scene.torques().end(),
                     [](const AnyTorque& torque) { return std::holds_alternative<During>(torque); });
}

Pieces cut(const Scene& scene, std::vector<double> more) {
  const auto [first, last] = find_span(scene);
  const double t0 = scene.t0();
  std::vector<double> edges = std::move(more);
  for (const AnyTorque& torque : scene.torques()) {
    const During* during = find_windows(torque);
    if (during == nullptr) continue;
    for (const torques::Window& window : during->windows()) {
      for (const double t : {window.begin, window.end}) {
        if (first < t && t < last) edges.push_back(t);
      }
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());

  Pieces pieces;
  pieces.whole = edges.empty();
  const auto add = [&](std::vector<Piece>& one_way, double end) {
    const double begin = one_way.empty() ? t0 : one_way.back().end;
    one_way.push_back({begin, end, find_acting(scene, std::min(begin, end), std::max(begin, end))});
  };
  if (std::any_of(scene.times().begin(), scene.times().end(), [t0](double t) { return t >= t0; })) {
    for (const double t : edges) {
      if (t > t0) add(pieces.forward, t);
    }
    add(pieces.forward, last);
  }
  if (first < t0) {
    for (auto t = edges.rbegin(); t != edges.rend(); ++t) {
      if (*t < t0) add(pieces.backward, *t);
    }
    add(pieces.backward, first);
  }
  return pieces;
}

Scene make_piece_scene(const Scene& scene, const Piece& piece, const State& start, std::vector<double> times,
                       const Wanted& want) {
  return Scene(SceneParts{.inertia_B = scene.inertia_B(),
                          .omega = start.omega,
                          .attitude = start.attitude,
                          .torques = piece.torques,
                          .times = std::move(times),
                          .want = want,
                          .t0 = start.t,
                          .name = scene.name()});
}

Scene drop_windows(const Scene& scene) {
  const auto [first, last] = find_span(scene);
  return make_piece_scene(scene, {first, last, find_acting(scene, first, last)}, scene.start(), scene.times(),
                          scene.want());
}

std::string describe_span(const Piece& piece) {
  return "from t = " + to_text(std::min(piece.begin, piece.end)) + " to " + to_text(std::max(piece.begin, piece.end)) +
         " s";
}

bool carries_attitude(const Scene& scene, const Pieces& pieces, const SolveOptions& options) {
  bool uses = scene.want().attitude || !options.events.empty();
  for (const auto* one_way : {&pieces.backward, &pieces.forward}) {
    for (const Piece& piece : *one_way) uses |= summarize(piece.torques).uses_attitude;
  }
  return uses;
}

Motion run_pieces(const Scene& scene, const Pieces& pieces, const SolveOptions& options, const RunPiece& run,
                  bool shaken) {
  const Wanted want{true, carries_attitude(scene, pieces, options)};
  Chain chain(scene, options, run, shaken);
  const Itinerary itinerary(scene.times(), scene.t0());
  if (chain.follow(pieces.backward, itinerary.backward, want)) chain.follow(pieces.forward, itinerary.forward, want);
  Motion motion = chain.finish();
  motion.plan = {"pieces", "", want.attitude ? "omega, attitude" : "omega"};
  return motion;
}

}  // namespace polhode
