#include "formula/packing.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>


namespace polhode::formula {

Packing::Packing(const Tape& tape) : offsets_(tape.slots().size(), -1), levels_(tape.slots().size(), 0) {
  int next = 0;
  for (const StateSlot& state : tape.state_slots()) {
    const bool given = state.start == StartKind::given;
    if (!given && next < Table::column_of(tape.states() - 1) + 1) next = Table::column_of(tape.states() - 1) + 1;
    const int offset = given ? Table::column_of(state.number) : next++;
    offsets_[static_cast<std::size_t>(state.slot)] = offset;
    next = std::max(next, offset + 1);
  }
  states_ = (next + 7) / 8, given_ = (Table::column_of(tape.states() - 1) + 8) / 8;
  int wave = 8 * states_;
  for (std::size_t i = 0; i < tape.slots().size(); ++i)
    if (tape.slots()[i].kind == SlotKind::wave) offsets_[i] = wave++;
  waves_ = (wave - 8 * states_ + 7) / 8;
  octets_ = states_ + waves_;
  find_levels(tape);
  std::map<std::pair<int, Stage::Kind>, Group> found;
  for (std::size_t i = 0; i < tape.slots().size(); ++i) {
    const Slot& slot = tape.slots()[i];
    if (slot.kind == SlotKind::state || slot.kind == SlotKind::wave) continue;
    Stage::Kind kind = Stage::Kind::sum;
    if (slot.kind == SlotKind::operation) {
      const bool product = tape.operations()[static_cast<std::size_t>(slot.index)].rule == Rule::product;
      kind = product ? Stage::Kind::product : Stage::Kind::general;
    }
    Group& group = found.try_emplace({levels_[i], kind}, Group{kind, levels_[i], {}, 0}).first->second;
    group.slots.push_back(static_cast<int>(i));
  }
  for (auto& [key, group] : found) {
    sort_by_use(tape, group.slots);
    group.first_octet = octets_;
    octets_ += (static_cast<int>(group.slots.size()) + 7) / 8;
    place(group);
    groups_.push_back(std::move(group));
  }
}

void Packing::sort_by_use(const Tape& tape, std::vector<int>& slots) const {
  std::map<int, std::pair<int, int>> use;
  for (const StateSlot& state : tape.state_slots()) {
    int rank = 0;
    for (const Term& term : state.rate.terms)
      if (tape.slots()[static_cast<std::size_t>(term.node)].kind != SlotKind::state)
        use.try_emplace(term.node, rank++, offset_of(state.slot));
  }
  const auto key = [&](int slot) {
    const auto found = use.find(slot);
    return found == use.end() ? std::pair(1 << 20, slot) : found->second;
  };
  std::stable_sort(slots.begin(), slots.end(), [&](int a, int b) { return key(a) < key(b); });
}

void Packing::place(const Group& group) {
  int offset = 8 * group.first_octet;
  for (const int slot : group.slots) offsets_[static_cast<std::size_t>(slot)] = offset++;
}

void Packing::find_levels(const Tape& tape) {
  const auto level = [&](int slot) { return levels_[static_cast<std::size_t>(slot)]; };
  for (std::size_t i = 0; i < tape.slots().size(); ++i) {
    const Slot& slot = tape.slots()[i];
    const auto index = static_cast<std::size_t>(slot.index);
    int highest = 0;
    if (slot.kind == SlotKind::linear) {
      for (const Term& term : tape.forms()[index].terms) highest = std::max(highest, level(term.node));
      levels_[i] = highest + 1;
    } else if (slot.kind == SlotKind::operation) {
      const Recurrence& op = tape.operations()[index];
      for (const int operand : {op.a, op.b, op.first, op.second})
        if (operand >= 0) highest = std::max(highest, level(operand));
      levels_[i] = highest + 1;
    }
  }
}

namespace {

/// Finds out how the used lanes move, and gives the others what makes it simple.
/// @param may_read  whether a lane that is not used may read a place
template <class MayRead>
void simplify(Pick& pick, const std::vector<bool>& used, const MayRead& may_read) {
  const auto first = static_cast<std::size_t>(std::find(used.begin(), used.end(), true) - used.begin());
  if (first == used.size()) return;
  const std::int32_t octet = pick.offset[first] / 8 * 8;
  bool stays = true, spreads = true;
  for (std::size_t i = 0; i < 8; ++i) {
    const auto own = static_cast<std::int32_t>(octet + static_cast<std::int32_t>(i));
    stays = stays && (used[i] ? pick.offset[i] == own : may_read(own));
    spreads = spreads && (!used[i] || pick.offset[i] == pick.offset[first]);
  }
  if (!stays && !spreads) return;
  pick.move = stays ? Pick::Move::none : Pick::Move::spread;
  for (std::size_t i = 0; i < 8; ++i) {
    pick.offset[i] = stays ? octet + static_cast<std::int32_t>(i) : pick.offset[first];
    pick.index[i] = pick.offset[i] % 8;
  }
  pick.first = pick.second = octet;
}

}  // namespace

std::vector<Pick> pick_operands(const std::vector<int>& offsets) {
  std::set<int> rest;
  int any = 0;
  for (const int offset : offsets)
    if (offset >= 0) rest.insert(offset / 8), any = offset;
  std::vector<Pick> picks;
  while (!rest.empty()) {
    Pick pick;
    const int first = *rest.begin();
    rest.erase(rest.begin());
    int second = first;
    if (!rest.empty()) second = *rest.begin(), rest.erase(rest.begin());
    pick.first = 8 * first, pick.second = 8 * second;
    for (std::size_t i = 0; i < 8; ++i) {
      const int offset = i < offsets.size() && offsets[i] >= 0 ? offsets[i] : any;
      pick.offset[i] = offset;
      pick.index[i] = offset % 8 + (offset / 8 == first ? 0 : 8);
      if (offset / 8 == first || offset / 8 == second) pick.mask |= 1 << i;
    }
    picks.push_back(pick);
  }
  if (picks.size() != 1) return picks;
  std::vector<bool> used(8, false);
  for (std::size_t i = 0; i < offsets.size(); ++i) used[i] = offsets[i] >= 0;
  simplify(picks.front(), used, [](int) { return true; });
  return picks;
}

std::vector<Pick> pick_terms(std::vector<Form*> lanes, const Packing& packing) {
  struct Part {
    int octet;
    Term term;
  };
  std::vector<std::vector<Part>> rest(lanes.size());
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    for (const Term& term : lanes[i]->terms) rest[i].push_back({packing.octet_of(term.node), term});
    std::stable_sort(rest[i].begin(), rest[i].end(), [](const Part& a, const Part& b) { return a.octet < b.octet; });
  }
  struct Choice {
    Pick pick;
    std::vector<std::pair<std::size_t, Term>> taken;
  };
  std::vector<Choice> choices;
  for (;;) {
    std::set<int> octets;
    for (const auto& parts : rest)
      for (const Part& part : parts) octets.insert(part.octet);
    if (octets.empty()) break;
    // The pair of octets that serves the most lanes; of equals the earliest, whose values are known first.
    int first = *octets.begin(), second = first, most = 0;
    for (const int a : octets) {
      for (auto b = octets.find(a); b != octets.end(); ++b) {
        const auto serves = [&](const std::vector<Part>& parts) {
          return std::any_of(parts.begin(), parts.end(), [&](const Part& p) { return p.octet == a || p.octet == *b; });
        };
        const int served = static_cast<int>(std::count_if(rest.begin(), rest.end(), serves));
        if (served > most) most = served, first = a, second = *b;
      }
    }
    Choice choice;
    choice.pick.first = 8 * first, choice.pick.second = 8 * second;
    int any = -1;
    for (std::size_t i = 0; i < rest.size(); ++i) {
      const auto part = std::find_if(rest[i].begin(), rest[i].end(),
                                     [&](const Part& p) { return p.octet == first || p.octet == second; });
      if (part == rest[i].end()) continue;
      const int offset = packing.offset_of(part->term.node);
      choice.pick.factor[i] = part->term.factor, choice.pick.offset[i] = offset, choice.pick.mask |= 1 << i;
      choice.taken.emplace_back(i, part->term);
      any = offset;
      rest[i].erase(part);
    }
    for (std::size_t i = 0; i < 8; ++i) {
      if ((choice.pick.mask >> i & 1) == 0) choice.pick.offset[i] = any;   // times 0
      const int offset = choice.pick.offset[i];
      choice.pick.index[i] = offset % 8 + (offset / 8 == first ? 0 : 8);
    }
    std::vector<bool> used(8, false);
    for (const auto& [lane, term] : choice.taken) used[lane] = true;
    simplify(choice.pick, used, [&](int offset) { return packing.is_taken(offset); });
    choices.push_back(std::move(choice));
  }
  const auto latest = [](const Choice& c) { return std::max(c.pick.first, c.pick.second); };
  std::stable_sort(choices.begin(), choices.end(),
                   [&](const Choice& a, const Choice& b) { return latest(a) < latest(b); });
  for (Form* lane : lanes) lane->terms.clear();
  std::vector<Pick> picks;
  for (const Choice& choice : choices) {
    for (const auto& [lane, term] : choice.taken) lanes[lane]->terms.push_back(term);
    picks.push_back(choice.pick);
  }
  return picks;
}

}  // namespace polhode::formula
