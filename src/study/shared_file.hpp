#pragma once

#include "graze/results/result_file.hpp"

#include <mutex>

namespace graze {

/// A result file that several runs write to, one at a time.
class SharedFile {
public:
    explicit SharedFile(ResultFile& file) : file_(&file) {}

    /// Does something with the file while nobody else does. @param work given the file; not to be called within another
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
