#pragma once

#include <algorithm>
#include <vector>

#include "polhode/formula/table.hpp"

namespace polhode::formula {

/// Slots of one level and kind, eight an octet in this order; the last octet may have free lanes.
struct Group {
  Stage::Kind kind;
  int level;
  std::vector<int> slots;
  int first_octet = 0;
};

/// The places of a tape's slots: value octets from the states on, by level.
class Packing {
 public:
  explicit Packing(const Tape& tape);

  /// Where a slot is among all values.
  int offset_of(int slot) const { return offsets_[static_cast<std::size_t>(slot)]; }
  int octet_of(int slot) const { return offset_of(slot) / 8; }
  /// Whether a place has a number. Others may hold NaN.
  bool is_taken(int offset) const { return std::find(offsets_.begin(), offsets_.end(), offset) != offsets_.end(); }

  const std::vector<Group>& groups() const { return groups_; }   ///< operations and forms, by level
  int states() const { return states_; }
  int given() const { return given_; }
  int waves() const { return waves_; }
  int octets() const { return octets_; }

 private:
  void find_levels(const Tape& tape);
  void place(const Group& group);
  /// Operations that are the first terms of all rates side by side, then those that are the second terms, ...
  void sort_by_use(const Tape& tape, std::vector<int>& slots) const;

  std::vector<int> offsets_, levels_;
  std::vector<Group> groups_;
  int states_ = 0, given_ = 0, waves_ = 0, octets_ = 0;
};

/// Picks that bring numbers from these places to lanes 0, 1, ...; negative places are free lanes.
std::vector<Pick> pick_operands(const std::vector<int>& offsets);

/// Picks of sums, one form a lane, by offsets. Sorts the terms of the forms as the picks have them.
std::vector<Pick> pick_terms(std::vector<Form*> lanes, const Packing& packing);

}  // namespace polhode::formula
