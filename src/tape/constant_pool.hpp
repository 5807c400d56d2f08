#pragma once

#include "graze/tape/tape.hpp"

#include <map>
#include <optional>
#include <tuple>
#include <vector>

namespace graze {

/// The constants of a tape while it is compiled: parameters first, then literals and what is computed from them.
/// Equal constants exist once; operations on literals are done at once.
class ConstantPool {
public:
    explicit ConstantPool(std::uint32_t parameters);

    std::uint32_t literal(double value);
    std::uint32_t apply(Operation operation, std::uint32_t left, std::uint32_t right = 0);
    /// The value, if it is a literal.
    std::optional<double> value_of(std::uint32_t constant) const;
    bool is(std::uint32_t constant, double value) const { return value_of(constant) == value; }

    /// Moves the constants that the tape uses into it, and renumbers them there.
    void move_to(Tape& tape) const;

private:
    struct Entry {
        bool is_literal = false;
        double value = 0;
        ConstantInstruction code{};
    };
    std::uint32_t parameters_;
    std::vector<Entry> entries_;
    std::map<std::uint64_t, std::uint32_t> literals_;
    std::map<std::tuple<Operation, std::uint32_t, std::uint32_t>, std::uint32_t> results_;
};

} // namespace graze
