// A replacement for CGAL's Double_map, the queue of its mesh refinement. CGAL's own takes equally urgent
// elements in an order that depends on their addresses in memory, so that two runs on the same samples can
// end in different meshes. Include it before any CGAL header: it stands in for <CGAL/Double_map.h>.
#pragma once

#ifdef CGAL_DOUBLE_MAP_H
#error "stable_double_map.hpp has to come before CGAL's headers"
#endif
#define CGAL_DOUBLE_MAP_H

#include <cstddef>
#include <functional>
#include <map>
#include <utility>

namespace CGAL {

/// Keys with a priority each: found by key, taken by least priority, first come first served.
template <class KeyType, class DataType, class DirectCompare = std::less<KeyType>,
          class ReverseCompare = std::less<DataType>>
class Double_map {
 public:
  using Key = KeyType;
  using Data = DataType;
  using Reverse_func = std::multimap<Data, Key, ReverseCompare>;
  using reverse_iterator = typename Reverse_func::iterator;
  using iterator = reverse_iterator;
  using size_type = std::size_t;

  Double_map() = default;
  Double_map(const Double_map&) = delete;
  Double_map& operator=(const Double_map&) = delete;

  [[nodiscard]] bool empty() const { return by_key_.empty(); }
  [[nodiscard]] size_type size() const { return by_key_.size(); }
  void clear() {
    by_key_.clear();
    by_data_.clear();
  }
  /// Whether the key was new; a key that is there keeps its priority.
  bool insert(const Key& key, const Data& data) {
    const auto [place, is_new] = by_key_.try_emplace(key);
    if (is_new) place->second = by_data_.emplace(data, key);
    return is_new;
  }
  bool erase(const Key& key) {
    const auto place = by_key_.find(key);
    if (place == by_key_.end()) return false;
    by_data_.erase(place->second);
    by_key_.erase(place);
    return true;
  }
  /// ->first is the priority, ->second the key. Not empty.
  reverse_iterator front() { return by_data_.begin(); }
  void pop_front() {
    by_key_.erase(by_data_.begin()->second);
    by_data_.erase(by_data_.begin());
  }

 private:
  Reverse_func by_data_;
  std::map<Key, reverse_iterator, DirectCompare> by_key_;
};

}  // namespace CGAL
