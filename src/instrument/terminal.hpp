#pragma once

#include "instrument/descriptor.hpp"

#include <string>

namespace graze {

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
