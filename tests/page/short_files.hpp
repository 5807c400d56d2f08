#pragma once

#include <sys/resource.h>

#include <csignal>

namespace graze::testing {

/// While it exists, this process writes no file of more than some bytes.
class ShortFiles {
public:
    explicit ShortFiles(rlim_t most) : action_(std::signal(SIGXFSZ, SIG_IGN)) {
        ::getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit limit{most, before_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~ShortFiles() {
        ::setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, action_);
    }
    ShortFiles(const ShortFiles&) = delete;
    ShortFiles& operator=(const ShortFiles&) = delete;

private:
    void (*action_)(int);
    rlimit before_{};
};

} // namespace graze::testing
