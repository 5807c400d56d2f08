#pragma once

#include "tape/constant_pool.hpp"

#include <map>
#include <vector>

namespace graze {

/// An expression during compilation: a constant plus constants times registers, sorted by register. Sums are kept in
/// this form as long as possible, so that one instruction computes a whole sum.
struct LinearForm {
    std::uint32_t constant = 0;
    std::vector<Term> terms;

    bool is_constant() const { return terms.empty(); }
};

/// Emits instructions on series for operations on linear forms.
class SeriesBuilder {
public:
    SeriesBuilder(std::uint32_t states, std::uint32_t parameters);

    LinearForm constant(std::uint32_t index) const { return {index, {}}; }
    LinearForm number(double value) { return {constants_.literal(value), {}}; }
    LinearForm series(std::uint32_t reg) const { return {zero_, {{reg, one_}}}; }

    LinearForm apply(Operation operation, LinearForm left, LinearForm right);
    /// From now on, new quotients are compiled as products with reciprocals, many of which are shared.
    void prefer_reciprocals() { prefers_reciprocals_ = true; }

    /// Returns the same form with at most one register, so that using it several times repeats no work.
    LinearForm shared(LinearForm form);
    /// Returns where the form is stored; emits the instruction that computes it if necessary.
    Tape::Location location(const LinearForm& form);

    /// Moves code, terms and the number of registers to the tape; the constants are moved by `constants`.
    void move_to(Tape& tape);
    const ConstantPool& constants() const { return constants_; }

private:
    using Key = std::vector<std::uint32_t>;
    struct Scaled {
        std::uint32_t coefficient;
        std::uint32_t reg;
    };

    LinearForm add(LinearForm left, LinearForm right);
    LinearForm scale(LinearForm form, std::uint32_t coefficient);
    LinearForm scaled(Scaled scaled) const { return {zero_, {{scaled.reg, scaled.coefficient}}}; }
    LinearForm multiply(LinearForm left, LinearForm right);
    LinearForm divide(LinearForm left, const LinearForm& right);
    bool is_moderate(std::uint32_t coefficient) const;
    LinearForm power(LinearForm base, LinearForm exponent);
    LinearForm integer_power(Scaled base, double exponent);
    LinearForm half_integer_power(std::uint32_t base, double exponent);
    LinearForm function(Operation operation, std::uint32_t a);
    std::uint32_t hyperbolic_or_circular(SeriesOperation one, SeriesOperation other, std::uint32_t a, bool want_one);
    std::uint32_t tangent(Operation operation, std::uint32_t a);
    std::uint32_t inverse_function(Operation operation, std::uint32_t a);

    std::uint32_t reg_of(const LinearForm& form);
    Scaled split(const LinearForm& form);
    std::uint32_t multiply(std::uint32_t left, std::uint32_t right);
    std::uint32_t reciprocal_of(std::uint32_t a);
    std::uint32_t emit(SeriesOperation operation, std::uint32_t left, std::uint32_t right = 0, std::uint32_t third = 0);
    /// 1 + sign a^2
    std::uint32_t one_and_square(std::uint32_t a, double sign);

    static Key key_of(SeriesOperation operation, std::uint32_t left, std::uint32_t right, std::uint32_t third);
    /// True when a register already holds the result of this instruction.
    bool is_known(SeriesOperation operation, std::uint32_t left, std::uint32_t right = 0) const {
        return known_.contains(key_of(operation, left, right, 0));
    }

    bool prefers_reciprocals_ = false;
    std::uint32_t registers_;
    ConstantPool constants_;
    std::uint32_t zero_;
    std::uint32_t one_;
    std::vector<Instruction> code_;
    std::vector<Term> terms_;
    std::map<Key, std::uint32_t> known_;           ///< registers by the instruction that computes them
    std::map<std::uint32_t, std::uint32_t> roots_; ///< for registers that are squares, the register that is squared
};

} // namespace graze
