#pragma once

#include "graze/results/result_file.hpp"

#include <mutex>

namespace graze {

/// A result file that several runs write to, one at a time.
class SharedFile {
public:
    explicit SharedFile(ResultFile& file) : file_(&file) {}

    /// Calls `work` with the file while no other thread uses it. Calls must not be nested.
    template <class Work>
    auto with(const Work& work) {
        const std::lock_guard lock(mutex_);
        return work(*file_);
    }

private:
    ResultFile* file_;
    std::mutex mutex_;
};

} // namespace graze
