#pragma once

#include <unistd.h>

namespace graze {

/// Owns a file descriptor.
class Descriptor {
public:
    explicit Descriptor(int file = -1) : file_(file) {}
    ~Descriptor() { reset(); }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int get() const { return file_; }
    void reset(int file = -1) {
        if (file_ >= 0)
            close(file_);
        file_ = file;
    }

private:
    int file_;
};

} // namespace graze
