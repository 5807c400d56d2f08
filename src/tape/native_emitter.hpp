#pragma once

#include "tape/native_registers.hpp"
#include "tape/native_sums.hpp"

#include <span>
#include <unordered_set>

namespace graze {

/// Generates x86-64 code that computes coefficients of all series of a tape, either those of orders 0 and 1 from the
/// values of the states, or all others from these: a function of the memory of a jet, scratch memory, and the operands
/// of the kernels that it calls.
class NativeEmitter {
public:
    struct Setting {
        std::span<const NativeStep> steps;        ///< of orders 0 and 1, or of all others
        int highest;                              ///< order
        const std::unordered_set<Offset>& stored; ///< series that others than the code need
        bool wide;                                ///< for AVX-512 instead of AVX2
        std::size_t first_call; ///< number of kernels that other code calls, whose operands come first
    };
    /// @param known the uses found the first time
    NativeEmitter(const Setting& setting, const NativeRegisters::Uses* known);

    void emit();
    bool failed() const { return errors_.failed; }
    std::span<const std::uint8_t> code() const;
    const NativeRegisters::Uses& uses() const { return registers_.uses(); }
    std::size_t scratch() const { return static_cast<std::size_t>(sums_.end()); } ///< numbers of scratch memory
    std::span<const NativeStep> calls() const { return calls_; }                  ///< the kernels called, in this order

    // Constants in the scratch memory: numbers k at `integers` + k, and so on.
    static constexpr Offset inverses = 0, negative_inverses = highest_order + 1, integers = 2 * (highest_order + 1),
                            first_slot = 3 * (highest_order + 1);

private:
    struct Errors final : asmjit::ErrorHandler {
        void handleError(asmjit::Error, const char*, asmjit::BaseEmitter*) override { failed = true; }
        bool failed = false;
    };

    void find_slots();
    void emit_beginning();
    void emit(const NativeStep& step);
    void emit_first_orders(const NativeStep& step);
    void emit_value(const NativeStep& step);
    void emit_slope(const NativeStep& step);
    x86::Xmm minus_product(Offset a, x86::Xmm b);
    void define(const NativeStep& step, x86::Xmm value) { define(step.result, step.order, value); }
    void define(Offset series, int order, x86::Xmm value) {
        registers_.define(series + order, value, stores_all_ || stored_.contains(series));
    }
    Offset inverse_of(const NativeStep& step) const {
        return scratch_begin + (step.negative ? negative_inverses : inverses) + step.order;
    }
    x86::Xmm copy_of(Offset number);
    x86::Xmm product_of_three(Offset a, Offset b, Offset c);
    x86::Xmm convolution(const NativeProduct& product, int order);
    x86::Xmm self_convolution(const NativeStep& step);
    x86::Xmm linear_sum(const NativeStep& step, int order);
    x86::Xmm long_sum(const NativeStep& step, int order);
    void emit_product(const NativeStep& step);
    void emit_quotient(const NativeStep& step);
    void emit_root(const NativeStep& step);
    void emit_function(const NativeStep& step);
    void emit_linear(const NativeStep& step);
    void emit_pair(const NativeStep& step);
    void emit_call(const NativeStep& step);

    std::span<const NativeStep> steps_;
    int highest_;
    const std::unordered_set<Offset>& stored_;
    bool stores_all_; ///< kernels that are called, and the other code, read and write memory
    std::size_t first_call_;
    std::map<Offset, Offset>
        slots_; ///< scratch memory for a number by which each coefficient of a series is multiplied
    Errors errors_;
    asmjit::CodeHolder code_;
    x86::Assembler assembler_;
    NativeRegisters registers_;
    NativeSums sums_;
    std::vector<NativeStep> calls_;
};

} // namespace graze
