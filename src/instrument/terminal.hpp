#pragma once

#include <string>

namespace graze {

/// A pseudo-terminal under a name of one's own, from the side of the instrument.
class Terminal {
public:
    /// @param name of a link to it; a link to a terminal that is there already, left by a process that was killed, is
    ///             replaced, and nothing else is
    /// @throws InputError when it cannot be made
    explicit Terminal(std::string name);
    ~Terminal();
    Terminal(const Terminal&) = delete;
    Terminal& operator=(const Terminal&) = delete;

    int file() const { return master_; }

private:
    void close_both() const;
    std::string name_, target_;
    int master_ = -1, slave_ = -1;
};

} // namespace graze
