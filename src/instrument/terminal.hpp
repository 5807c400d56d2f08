#pragma once

#include <unistd.h>

#include <string>

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

/// The instrument's end of a pseudo-terminal, which a link names.
class Terminal {
public:
    /// @param name of the link; only an existing link to a terminal, left by a process that was killed, is replaced
    /// @throws InputError when it cannot be created
    explicit Terminal(std::string name);
    ~Terminal();
    Terminal(const Terminal&) = delete;
    Terminal& operator=(const Terminal&) = delete;

    int file() const { return master_.get(); }

private:
    std::string name_, target_;
    Descriptor master_, slave_;
};

} // namespace graze
