#pragma once

#include <algorithm>
#include <cstddef>
#include <new>

namespace graze {

/// An array of numbers aligned to cache lines, initially 0.
class AlignedNumbers {
public:
    explicit AlignedNumbers(std::size_t count)
        : numbers_(static_cast<double*>(::operator new(count * sizeof(double), alignment))) {
        std::fill_n(numbers_, count, 0.0);
    }
    AlignedNumbers(const AlignedNumbers&) = delete;
    AlignedNumbers& operator=(const AlignedNumbers&) = delete;
    ~AlignedNumbers() { ::operator delete(numbers_, alignment); }

    double* data() const { return numbers_; }

private:
    static constexpr std::align_val_t alignment{64};
    double* numbers_;
};

} // namespace graze
