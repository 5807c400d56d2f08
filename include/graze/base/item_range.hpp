#pragma once

#include <cstddef>

namespace graze {

/// Items of some work that follow one another, such as chains of a run or devices of a yield: from `first` on, before
/// `last`.
struct ItemRange {
    std::size_t first = 0, last = 0;
    std::size_t size() const { return last - first; }
};

} // namespace graze
