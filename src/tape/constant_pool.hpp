#pragma once

#include "graze/tape/tape.hpp"

#include <map>
#include <optional>
#include <tuple>
#include <vector>

namespace graze {

/// The constants of a tape during compilation: parameters first, then literals and results of operations on them. Equal
/// constants exist once; operations on literals are evaluated immediately.
class ConstantPool {
public:
    explicit ConstantPool(std::uint32_t parameters);

    std::uint32_t literal(double value);
    std::uint32_t apply(Operation operation, std::uint32_t left, std::uint32_t right = 0);
    /// Returns the value if the constant is a literal.
    std::optional<double> value_of(std::uint32_t constant) const;
    bool is(std::uint32_t constant, double value) const { return value_of(constant) == value; }

    /// Moves the constants that the tape uses into it, and renumbers the tape's references.
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
