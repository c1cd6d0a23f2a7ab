#include "polhode/batch/summary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <string>
#include <utility>

#include "batch/free_block.hpp"
#include "batch/parallel.hpp"
#include "batch/rows.hpp"
#include "batch/summary/reducer.hpp"
#include "batch/summary/tree.hpp"
#include "polhode/core/error.hpp"

namespace polhode {
namespace {

using Of = SummaryQuantity::Of;
using summary::Layout, summary::Reducer;

/// The range of a histogram, and the components of the reference by quantity.
void complete(SummaryQuantity& q, std::size_t times, std::size_t index) {
  const std::string name = "quantities[" + std::to_string(index) + "]";
  constexpr int ranges[][2] = {{-58, 2}, {-58, 2}, {-40, 20}, {-60, 40}, {-40, 20}, {0, 0}};
  const int* range = ranges[static_cast<int>(q.of)];
  if (q.first == 0 && q.last == 0) q.first = range[0], q.last = range[1];
  if (q.of != Of::attitude && !(q.first < q.last && q.first >= -1000 && q.last <= 1000))
    throw InvalidInput(name, "least < largest for its histogram, within 2^-1000 and 2^1000",
                       "2^" + std::to_string(q.first) + ", 2^" + std::to_string(q.last));
  if (q.of == Of::attitude && q.reference.empty()) q.reference = {0.0, 0.0, 0.0, 1.0};
  const std::size_t width = q.of == Of::axis_angle ? 3 : 4;
  const bool needed = q.of == Of::angle || q.of == Of::axis_angle || q.of == Of::attitude;
  if (!needed) return q.reference.clear();
  if (q.reference.size() != width && q.reference.size() != width * times)
    throw InvalidInput(name, "one reference, or one for each time", std::to_string(q.reference.size()) + " numbers");
  const auto require_unit = [&](const double* row, std::size_t n, const char* what) {
    double square = 0.0;
    for (std::size_t i = 0; i < n; ++i) square = square + row[i] * row[i];
    if (!(std::abs(square - 1.0) <= 2e-6)) throw InvalidInput(name, what, "norm " + to_text(std::sqrt(square)));
  };
  for (std::size_t i = 0; i < q.reference.size(); i += width)
    require_unit(q.reference.data() + i, width,
                 width == 4 ? "a unit quaternion as nominal" : "a unit vector as target");
  if (q.of == Of::axis_angle) require_unit(q.axis.data(), 3, "a unit vector as axis");
}

/// The components of a reference, each in a row of padded length; of a constant one, a vector each.
std::vector<double> to_planes(const SummaryQuantity& q) {
  const std::size_t width = q.of == Of::axis_angle ? 3 : 4, n = q.reference.size() / width;
  const std::size_t row = summary::padded(n);
  std::vector<double> planes(n == 0 ? 0 : width * row, 0.0);
  for (std::size_t c = 0; c < width; ++c)
    for (std::size_t k = 0; n > 0 && k < row; ++k) planes[c * row + k] = q.reference[width * std::min(k, n - 1) + c];
  return planes;
}

void merge_totals(Summary::Totals& to, const Summary::Totals& from) {
  for (std::size_t i = 0; i < to.count.size(); ++i) {
    to.count[i] += from.count[i];
    to.least[i] = std::min(to.least[i], from.least[i]), to.largest[i] = std::max(to.largest[i], from.largest[i]);
  }
  for (std::size_t q = 0; q < to.bins.size(); ++q)
    for (std::size_t i = 0; i < to.bins[q].size(); ++i) to.bins[q][i] += from.bins[q][i];
  to.failed += from.failed;
}

/// xx, yy, zz, xy, xz, yz.
void copy_tensor(const Matrix3d& I, double* to) {
  const double entries[] = {I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2)};
  std::copy_n(entries, 6, to);
}

/// States of free bodies, for one thread.
class FreeSource {
 public:
  FreeSource(const FreeMotionBatch& batch, const exact::TimeGrid& grid, double reach)
      : b_(batch), grid_(grid), reach_(reach), block_(batch) {
    if (batch.tensor) copy_tensor(batch.tensor->matrix(), tensor_);
  }

  void take(std::size_t begin, std::size_t end) {
    block_.take(begin, end, [this](std::size_t) { return reach_; });
    block_.set_up();
    begin_ = begin;
  }

  /// Returns false if a row is not finite.
  bool measure(Reducer& reducer, std::size_t i, std::size_t from, std::size_t n) {
    if (block_.has_failed(i)) {
      for (std::size_t k = 0; k < n; ++k) reducer.leave_out(i, k);
      return false;
    }
    block_.evaluate(i, grid_.piece(from, n), reducer.omega(), reducer.attitude());
    if (!b_.tensor) std::copy_n(b_.moments + 3 * (begin_ + i), 3, tensor_);
    reducer.measure(i, from, n, tensor_, nullptr);
    return true;
  }

 private:
  const FreeMotionBatch& b_;
  exact::TimeGrid grid_;
  double reach_, tensor_[6] = {};
  FreeBlock block_;
  std::size_t begin_ = 0;
};

/// States that are given.
class GivenSource {
 public:
  GivenSource(const Summary::States& states, const Layout& layout) : s_(states), layout_(layout) {}

  void take(std::size_t begin, std::size_t) { begin_ = begin; }

  bool measure(Reducer& reducer, std::size_t i, std::size_t from, std::size_t n) {
    const std::size_t body = begin_ + i, row = body * layout_.times + from;
    if (reducer.omega()) std::copy_n(s_.omega + 3 * row, 3 * n, reducer.omega());
    if (reducer.attitude()) std::copy_n(s_.attitude + 4 * row, 4 * n, reducer.attitude());
    const double* values = s_.values ? s_.values + body * layout_.times * layout_.values : nullptr;
    reducer.measure(i, from, n, s_.tensors ? s_.tensors + (s_.one_tensor ? 0 : 6 * body) : nullptr, values);
    const auto fine = [](const double* of, std::size_t width, std::size_t at, std::size_t count) {
      return of == nullptr || within(of + width * at, width * count);
    };
    const std::size_t width = layout_.values;
    if (fine(s_.omega, 3, row, n) && fine(s_.attitude, 4, row, n) && fine(s_.values, width, row, n)) return true;
    for (std::size_t k = 0; k < n; ++k) {
      if (!fine(s_.omega, 3, row + k, 1) || !fine(s_.attitude, 4, row + k, 1) || !fine(s_.values, width, row + k, 1))
        reducer.leave_out(i, k);
    }
    return false;
  }

 private:
  const Summary::States& s_;
  const Layout& layout_;
  std::size_t begin_ = 0;
};

/// Adds bodies [begin, end) of one block, in order.
template <class Source>
void add_bodies(Source& source, Reducer& reducer, const Layout& layout, std::size_t begin, std::size_t end,
                Summary::Totals& totals, Summary::Sums& sums) {
  for (std::size_t first = begin; first < end; first += summary::tile) {
    check_interrupt();
    const std::size_t bodies = std::min(summary::tile, end - first);
    bool sound[summary::tile];
    std::fill_n(sound, bodies, true);
    source.take(first, first + bodies);
    for (std::size_t from = 0; from < layout.times; from += summary::span) {
      const std::size_t n = std::min(summary::span, layout.times - from);
      for (std::size_t i = 0; i < bodies; ++i) sound[i] &= source.measure(reducer, i, from, n);
      reducer.add(bodies, from, n, totals, sums);
    }
    totals.failed += static_cast<std::uint64_t>(std::count(sound, sound + bodies, false));
  }
}

}  // namespace

Summary::Summary(std::vector<SummaryQuantity> quantities, std::size_t times)
    : quantities_(std::move(quantities)), times_(times) {
  if (times == 0) throw InvalidInput("times", "one or more", "0");
  for (std::size_t i = 0; i < quantities_.size(); ++i) {
    complete(quantities_[i], times, i);
    planes_.push_back(to_planes(quantities_[i]));
  }
  totals_ = Layout(quantities_, planes_, times_).make_totals();
}

void Summary::begin(std::uint64_t first, std::size_t bodies) {
  if (!started_) {
    if (first % block != 0) throw InvalidInput("first", "a multiple of 4096 at the first call", std::to_string(first));
    first_ = end_ = first, started_ = true;
  }
  if (first != end_ || (end_ % block != 0 && open_.empty()))
    throw InvalidInput("first", "the number of the next body, " + std::to_string(end_), std::to_string(first));
  if (bodies_ + bodies > std::numeric_limits<std::uint32_t>::max())
    throw InvalidInput("bodies", "less than 2^32 in one summary", std::to_string(bodies_ + bodies));
  for (std::uint64_t at = (end_ + block - 1) / block; at * block < first + bodies; ++at)
    summary::require_apart(nodes_, at, 0);
}

template <class Source>
void Summary::add(std::uint64_t first, std::size_t bodies, int threads, const Source& make_source) {
  const Layout layout(quantities_, planes_, times_);
  begin(first, bodies);
  auto source = make_source(layout);
  Reducer reducer(layout);
  const auto go_on = [&](std::size_t from, std::size_t to) {
    add_bodies(source, reducer, layout, from, to, totals_, open_);
    end_ += to - from, bodies_ += to - from;
    if (end_ % block == 0) summary::insert(nodes_, end_ / block - 1, 0, std::exchange(open_, {}));
  };
  std::size_t done = 0;
  if (end_ % block != 0) {
    done = std::min<std::size_t>(bodies, block - end_ % block);
    go_on(0, done);
  }
  constexpr std::size_t at_once = 64;   // blocks, whose sums are held until those before are added
  while (bodies - done >= block) {
    const std::size_t blocks = std::min(at_once, (bodies - done) / block), begin = done;
    std::vector<Sums> sums(blocks, layout.make_sums());
    const std::size_t workers = thread_count(threads, blocks * block * times_, 50000);
    std::mutex merging;
    parallel_for(blocks, std::min(workers, blocks), 1, [&](std::size_t from, std::size_t to) {
      auto own_source = make_source(layout);
      Reducer own_reducer(layout);
      Totals own;
      if (workers > 1) own = layout.make_totals();
      for (std::size_t k = from; k < to; ++k)
        add_bodies(own_source, own_reducer, layout, begin + k * block, begin + (k + 1) * block,
                   workers > 1 ? own : totals_, sums[k]);
      const std::lock_guard lock(merging);
      if (workers > 1) merge_totals(totals_, own);
    });
    for (Sums& sum : sums) {
      summary::insert(nodes_, end_ / block, 0, std::move(sum));
      end_ += block, bodies_ += block, done += block;
    }
  }
  if (done < bodies) {
    open_ = layout.make_sums();
    go_on(done, bodies);
  }
}

void Summary::add_free(std::uint64_t first, const FreeMotionBatch& given, int threads) {
  if (given.times != times_ || given.own_times || !within(given.t, given.times))
    throw InvalidInput("times", "finite, of all bodies, as many as the summary has", std::to_string(given.times));
  for (const SummaryQuantity& q : quantities_)
    if (q.of == Of::value) throw InvalidInput("quantities", "without a value, which only add_states takes", "one");
  if (given.tensor) FreeMotion(*given.tensor, Vector3d::Zero());  // refuses a body without a moment about some axis
  FreeMotionBatch batch = given;
  batch.refuse = false;
  const SharedTimes shared(exact::free_kernels().times, batch.t, batch.times, batch.bodies > 1);
  add(first, batch.bodies, threads,
      [&](const Layout&) { return FreeSource(batch, shared.grid, shared.reach); });
}

void Summary::add_states(std::uint64_t first, const States& states) {
  for (const SummaryQuantity& q : quantities_) {
    const bool rates = q.of == Of::omega || q.of == Of::energy;
    const char* missing = rates && states.omega == nullptr                    ? "omega"
                          : q.of == Of::energy && states.tensors == nullptr   ? "inertia"
                          : q.of == Of::value && states.values == nullptr     ? "values"
                          : !rates && q.of != Of::value && !states.attitude   ? "attitude"
                                                                              : nullptr;
    if (missing != nullptr) throw InvalidInput(missing, "given for these quantities", "none");
  }
  add(first, states.bodies, 1, [&](const Layout& layout) { return GivenSource(states, layout); });
}

std::map<std::uint64_t, Summary::Node> Summary::all_nodes() const {
  std::map<std::uint64_t, Node> nodes = nodes_;
  if (!open_.empty()) summary::insert(nodes, end_ / block, 0, open_);
  return nodes;
}

void Summary::merge(const Summary& other) {
  if (other.times_ != times_ || other.totals_.count.size() != totals_.count.size())
    throw InvalidInput("other", "a summary of the same quantities and times", "another");
  for (std::size_t q = 0; q < quantities_.size(); ++q) {
    const SummaryQuantity &a = quantities_[q], &b = other.quantities_[q];
    if (a.of != b.of || a.reference != b.reference || a.axis != b.axis || a.first != b.first || a.last != b.last)
      throw InvalidInput("other", "a summary of the same quantities and times", "another");
  }
  if (bodies_ + other.bodies_ > std::numeric_limits<std::uint32_t>::max())
    throw InvalidInput("other", "less than 2^32 bodies in all", std::to_string(bodies_ + other.bodies_));
  if (!other.started_) return;
  auto nodes = all_nodes(), more = other.all_nodes();
  for (const auto& [start, node] : more) summary::require_apart(nodes, start, node.level);
  for (auto& [start, node] : more) summary::insert(nodes, start, node.level, std::move(node.sums));
  nodes_ = std::move(nodes), open_.clear();
  merge_totals(totals_, other.totals_);
  first_ = started_ ? std::min(first_, other.first_) : other.first_;
  end_ = std::max(end_, other.end_), bodies_ += other.bodies_, started_ = true;
}

Summary::Record Summary::record() const {
  const Layout layout(quantities_, planes_, times_);
  const std::map<std::uint64_t, Node> nodes = all_nodes();
  const Sums sums = nodes.empty() ? layout.make_sums() : summary::fold(nodes);
  Record found{first_, end_, bodies_, totals_.failed, {}};
  for (std::size_t q = 0; q < quantities_.size(); ++q) {
    const Layout::Entry& e = layout.entries[q];
    const auto part = [&](const std::vector<double>& of, std::size_t row) {
      const auto from = of.begin() + static_cast<std::ptrdiff_t>(row * layout.row);
      return std::vector<double>(from, from + static_cast<std::ptrdiff_t>(times_));
    };
    Scalar& s = found.quantities.emplace_back();
    s.count = part(totals_.count, q);
    if (quantities_[q].of == Of::attitude) {
      for (std::size_t k = 0; k < times_; ++k)
        for (std::size_t i = 0; i < 10; ++i) s.moments.push_back(sums[(e.sums + i) * layout.row + k]);
      continue;
    }
    s.sum = part(sums, e.sums), s.sum2 = part(sums, e.sums + 1);
    s.least = part(totals_.least, q), s.largest = part(totals_.largest, q);
    for (std::size_t k = 0; k < times_; ++k) {
      const auto row = totals_.bins[q].begin() + static_cast<std::ptrdiff_t>(k * (e.bins + 1));
      s.histogram.insert(s.histogram.end(), row, row + static_cast<std::ptrdiff_t>(e.bins));
    }
  }
  return found;
}

Summary Summary::from_record(std::vector<SummaryQuantity> quantities, std::size_t times, const Record& record) {
  Summary made(std::move(quantities), times);
  const Layout layout(made.quantities_, made.planes_, times);
  if (record.quantities.size() != layout.entries.size() || record.end - record.first != record.bodies)
    throw InvalidInput("record", "one of these quantities, of consecutive bodies", "another");
  if (record.bodies == 0) return made;
  const std::uint64_t start = record.first / block, last = (record.end - 1) / block;
  int level = 0;
  while ((std::uint64_t{1} << level) < last - start + 1) ++level;
  if (record.first % block != 0 || start % (std::uint64_t{1} << level) != 0)
    throw InvalidInput("record", "of an aligned power of two of blocks of 4096 bodies",
                       "bodies " + std::to_string(record.first) + " to " + std::to_string(record.end));
  Sums sums = layout.make_sums();
  for (std::size_t q = 0; q < layout.entries.size(); ++q) {
    const Layout::Entry& e = layout.entries[q];
    const Scalar& s = record.quantities[q];
    const bool attitude = made.quantities_[q].of == Of::attitude;
    const std::size_t needed = attitude ? 0 : times;
    if (s.count.size() != times || s.sum.size() != needed || s.sum2.size() != needed || s.least.size() != needed ||
        s.largest.size() != needed || s.histogram.size() != times * e.bins ||
        s.moments.size() != (attitude ? 10 * times : 0))
      throw InvalidInput("record", "of the shapes of these quantities and times", "another");
    for (std::size_t k = 0; k < times; ++k) {
      const std::size_t at = q * layout.row + k;
      made.totals_.count[at] = s.count[k];
      for (std::size_t i = 0; attitude && i < 10; ++i) sums[(e.sums + i) * layout.row + k] = s.moments[10 * k + i];
      if (attitude) continue;
      sums[e.sums * layout.row + k] = s.sum[k], sums[(e.sums + 1) * layout.row + k] = s.sum2[k];
      made.totals_.least[at] = s.least[k], made.totals_.largest[at] = s.largest[k];
      std::copy_n(s.histogram.begin() + static_cast<std::ptrdiff_t>(k * e.bins), e.bins,
                  made.totals_.bins[q].begin() + static_cast<std::ptrdiff_t>(k * (e.bins + 1)));
    }
  }
  made.nodes_.emplace(start, Node{level, std::move(sums)});
  made.totals_.failed = record.failed;
  made.first_ = record.first, made.end_ = record.end, made.bodies_ = record.bodies, made.started_ = true;
  return made;
}

std::size_t Summary::bins(std::size_t quantity) const { return summary::count_bins(quantities_.at(quantity)); }

std::vector<double> Summary::edges(std::size_t quantity) const {
  const SummaryQuantity& q = quantities_.at(quantity);
  std::vector<double> sizes, found;
  for (int octave = q.first; octave < q.last; ++octave)
    for (int i = 0; i < bins_of_octave; ++i) sizes.push_back(std::ldexp(1.0 + i * (1.0 / bins_of_octave), octave));
  if (q.of == Of::attitude) return found;
  sizes.push_back(std::ldexp(1.0, q.last));
  const double infinity = std::numeric_limits<double>::infinity();
  if (q.of == Of::value) {
    found.push_back(-infinity);
    for (std::size_t i = sizes.size(); i-- > 0;) found.push_back(-sizes[i]);
  } else {
    found.push_back(0.0);
  }
  found.insert(found.end(), sizes.begin(), sizes.end());
  found.push_back(infinity);
  return found;
}

}  // namespace polhode
