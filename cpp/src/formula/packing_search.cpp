#include <cstdint>
#include <utility>

#include "formula/packing.hpp"

namespace polhode::formula {
namespace {

/// Instructions that one row takes to bring numbers to their lanes.
std::size_t count_picks(const Tape& tape, const Packing& packing) {
  std::size_t count = 0;
  std::vector<Form> forms = tape.forms();
  std::vector<int> operands[4];
  std::vector<Form*> lanes;
  for (const Group& group : packing.groups()) {
    for (std::size_t i = 0; i < group.slots.size(); ++i) {
      const int index = tape.slots()[static_cast<std::size_t>(group.slots[i])].index;
      if (group.kind == Stage::Kind::sum) {
        lanes.push_back(&forms[static_cast<std::size_t>(index)]);
      } else {
        const Recurrence& op = tape.operations()[static_cast<std::size_t>(index)];
        const int used[4] = {op.first, op.second, op.left, op.right};
        for (int k = 0; k < (group.kind == Stage::Kind::general ? 4 : 2); ++k)
          operands[k].push_back(packing.offset_of(used[k]));
      }
      if (i % 8 != 7 && i + 1 != group.slots.size()) continue;
      if (!lanes.empty()) count += pick_terms(std::exchange(lanes, {}), packing).size();
      for (std::vector<int>& each : operands)
        if (!each.empty()) count += pick_operands(std::exchange(each, {})).size();
    }
  }
  std::vector<Form> rates;
  for (const StateSlot& state : tape.state_slots()) rates.push_back(state.rate);
  for (int octet = 0; octet < packing.states(); ++octet) {
    for (std::size_t i = 0; i < rates.size(); ++i)
      if (packing.octet_of(tape.state_slots()[i].slot) == octet) lanes.push_back(&rates[i]);
    count += pick_terms(std::exchange(lanes, {}), packing).size();
  }
  return count;
}

}  // namespace

void Packing::improve(const Tape& tape, int effort) {
  std::uint64_t state = 2026;
  const auto draw = [&](std::size_t below) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return static_cast<std::size_t>((state >> 33) % below);
  };
  std::vector<std::size_t> large;   // groups where an exchange can change anything
  for (std::size_t i = 0; i < groups_.size(); ++i)
    if (groups_[i].slots.size() > 8) large.push_back(i);
  if (large.empty()) return;
  std::size_t best = count_picks(tape, *this);
  for (int attempt = 0; attempt < effort; ++attempt) {
    Group& group = groups_[large[draw(large.size())]];
    const std::size_t a = draw(group.slots.size()), b = draw(group.slots.size());
    if (a / 8 == b / 8) continue;
    std::swap(group.slots[a], group.slots[b]);
    place(group);
    const std::size_t count = count_picks(tape, *this);
    if (count <= best) {
      best = count;
    } else {
      std::swap(group.slots[a], group.slots[b]);
      place(group);
    }
  }
}

}  // namespace polhode::formula
