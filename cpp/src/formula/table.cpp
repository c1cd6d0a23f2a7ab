#include "polhode/formula/table.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include "core/choose_level.hpp"
#include "formula/lanes/levels.hpp"
#include "formula/packing.hpp"

namespace polhode::formula {
namespace {

TableKernel find_kernel(SimdLevel level) {
  return choose_level(level, baseline_table_kernel, avx2_table_kernel, avx512_table_kernel);
}

/// Writes stages and picks of a packing, and orders the terms of the forms.
class Writer {
 public:
  Writer(const Tape& tape, const Packing& packing, TableParts& parts)
      : tape_(tape), packing_(packing), parts_(parts), forms_(tape.forms()), extras_(tape.extra_forms()) {
    for (const StateSlot& state : tape.state_slots()) rates_.push_back(state.rate);
  }

  void write() {
    parts_.states = packing_.states(), parts_.given = packing_.given(), parts_.octets = packing_.octets();
    parts_.waves = packing_.waves(), parts_.first_wave = packing_.states();
    for (const Group& group : packing_.groups())
      for (std::size_t begin = 0; begin < group.slots.size(); begin += 8) write_stage(group, begin);
    std::vector<std::vector<Form*>> lanes(static_cast<std::size_t>(parts_.states), std::vector<Form*>(8, &nothing_));
    for (std::size_t i = 0; i < rates_.size(); ++i) {
      const int offset = packing_.offset_of(tape_.state_slots()[i].slot);
      lanes[static_cast<std::size_t>(offset / 8)][static_cast<std::size_t>(offset % 8)] = &rates_[i];
    }
    for (int i = 0; i < parts_.states; ++i) parts_.rates.push_back(make_sum(lanes[static_cast<std::size_t>(i)], i));
    parts_.first_extra = parts_.octets;
    for (std::size_t begin = 0; begin < extras_.size(); begin += 8) {
      std::vector<Form*> extra;
      for (std::size_t i = begin; i < std::min(begin + 8, extras_.size()); ++i) extra.push_back(&extras_[i]);
      parts_.stages.push_back(make_sum(std::move(extra), parts_.octets++));
      ++parts_.extras;
    }
  }

  void order_terms(Tape& tape) { tape.set_forms(std::move(forms_), std::move(rates_), std::move(extras_)); }

 private:
  Range add(const std::vector<Pick>& picks) {
    const std::ptrdiff_t begin = std::ssize(parts_.picks);
    parts_.picks.insert(parts_.picks.end(), picks.begin(), picks.end());
    return {begin, std::ssize(parts_.picks)};
  }

  Stage make_sum(std::vector<Form*> lanes, int octet) {
    Stage stage;
    stage.octet = octet;
    for (std::size_t i = 0; i < lanes.size(); ++i) stage.constant[i] = lanes[i]->constant;
    stage.first = add(pick_terms(std::move(lanes), packing_));
    return stage;
  }

  void write_stage(const Group& group, std::size_t begin) {
    const std::size_t end = std::min(begin + 8, group.slots.size());
    const int octet = group.first_octet + static_cast<int>(begin / 8);
    const auto slot = [&](std::size_t i) { return static_cast<std::size_t>(group.slots[i]); };
    if (group.kind == Stage::Kind::sum) {
      std::vector<Form*> lanes;
      for (std::size_t i = begin; i < end; ++i)
        lanes.push_back(&forms_[static_cast<std::size_t>(tape_.slots()[slot(i)].index)]);
      parts_.stages.push_back(make_sum(std::move(lanes), octet));
      return;
    }
    Stage stage;
    stage.kind = group.kind, stage.octet = octet, stage.store = parts_.stores++;
    std::vector<int> first, second, left, right;
    for (std::size_t lane = 0; lane < 8; ++lane) {
      // Free lanes have the constants of the first one. Their values are not read, so any operands will do.
      const int index = tape_.slots()[slot(begin + lane < end ? begin + lane : begin)].index;
      const Recurrence& op = tape_.operations()[static_cast<std::size_t>(index)];
      const auto place = [&](int operand) { return packing_.offset_of(operand); };
      const auto bring = [&](int operand) { return begin + lane < end ? place(operand) : -1; };
      first.push_back(bring(op.first)), second.push_back(bring(op.second));
      left.push_back(bring(op.left)), right.push_back(bring(op.right));
      stage.operations[lane] = index;
      stage.a[lane] = place(op.a), stage.b[lane] = op.b >= 0 ? place(op.b) : place(op.a);
      stage.weighted[lane] = op.left_weighted ? 1.0 : 0.0, stage.divided[lane] = op.divided ? 1.0 : 0.0;
    }
    stage.first = add(pick_operands(first)), stage.second = add(pick_operands(second));
    if (group.kind == Stage::Kind::general)
      stage.left = add(pick_operands(left)), stage.right = add(pick_operands(right));
    parts_.stages.push_back(stage);
  }

  const Tape& tape_;
  const Packing& packing_;
  TableParts& parts_;
  Form nothing_;
  std::vector<Form> forms_, rates_, extras_;
};

}  // namespace

Table::Table(Tape tape) : tape_(std::move(tape)) {
  const Packing packing(tape_);
  Writer writer(tape_, packing, parts_);
  writer.write();
  writer.order_terms(tape_);
  for (const StateSlot& state : tape_.state_slots()) start_columns_.push_back(packing.offset_of(state.slot));
  for (std::size_t i = 0; i < tape_.slots().size(); ++i)
    if (tape_.slots()[i].kind == SlotKind::wave)
      wave_columns_.push_back(packing.offset_of(static_cast<int>(i)) - 8 * parts_.first_wave);
  known_ = group_known();
}

std::vector<std::vector<std::ptrdiff_t>> Table::group_known() const {
  std::map<int, std::vector<std::ptrdiff_t>> groups;   // by the first number of a vector
  for (std::size_t i = 0; i < tape_.waves().size(); ++i) {
    const int seen = tape_.waves()[i].seen, number = seen % Ephemeris::size;
    if (seen >= 0) groups[seen - (number < Ephemeris::distance ? number % 3 : 0)].push_back(wave_columns_[i]);
  }
  std::vector<std::vector<std::ptrdiff_t>> found;
  for (auto& [first, columns] : groups) found.push_back(std::move(columns));
  return found;
}

double Table::compute_known_size(const double* workspace, int row, int which) const {
  const double* numbers = workspace + 8 * parts_.octets + static_cast<std::ptrdiff_t>(8 * parts_.waves) * row;
  double largest = 0.0;
  for (const std::ptrdiff_t column : known_[static_cast<std::size_t>(which)])
    largest = std::max(largest, std::abs(numbers[column]));
  return largest;
}

std::size_t Table::workspace_size(int order) const {
  const auto rows = static_cast<std::size_t>(order) + 1, count = parts_.stages.size();
  const auto octets = static_cast<std::size_t>(parts_.octets), stores = static_cast<std::size_t>(parts_.stores);
  return 8 * (octets + rows * static_cast<std::size_t>(parts_.waves) + rows * 2 * stores + 3 * count + 2 * stores +
              static_cast<std::size_t>(parts_.states) + 1) + tape_.state_slots().size();
}

void Table::compute_series(SimdLevel level, math::DD t, double unit, const double* y, int order, double* rows,
                           double* extras, double* workspace) const {
  Workspace w;
  const std::ptrdiff_t count = order + 1, stores = parts_.stores;
  w.values = workspace;
  w.waves = w.values + 8 * parts_.octets;
  w.stores = w.waves + 8 * count * parts_.waves;
  w.constants = w.stores + 16 * count * stores;
  w.older = w.constants + 24 * static_cast<std::ptrdiff_t>(parts_.stages.size());
  w.scratch = w.older + 16 * stores;
  double* starts = w.scratch + 8 * (parts_.states + 1);
  std::fill_n(w.values, 8 * (parts_.states + parts_.waves), 0.0);
  tape_.start(t, y, starts);
  for (std::size_t i = 0; i < start_columns_.size(); ++i) w.values[start_columns_[i]] = starts[i];
  if (parts_.waves > 0) {
    std::fill_n(w.waves, 8 * count * parts_.waves, 0.0);
    tape_.fill_waves(t, unit, order, wave_columns_, w.waves, 8 * parts_.waves);
    std::copy_n(w.waves, 8 * parts_.waves, w.values + 8 * parts_.first_wave);
  }
  find_kernel(level)(parts_, tape_.operations().data(), w, unit, order, rows, extras);
}

}  // namespace polhode::formula
