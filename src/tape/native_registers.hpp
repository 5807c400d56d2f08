#pragma once

#include "tape/native_steps.hpp"

#include <asmjit/x86.h>

#include <array>
#include <cstddef>
#include <map>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace graze {

namespace x86 = asmjit::x86;

/// Numbers in the scratch memory of generated code have offsets from here on; those below are in the memory of a jet.
inline constexpr Offset scratch_begin = Offset{1} << 40;

/// The registers that hold single numbers. Each number is a coefficient with an offset. When a register is needed, the
/// number goes that is not used for longest, and only then it is stored, unless others need it in memory. For this the
/// code is generated twice, the first time to learn where each number is used.
class NativeRegisters {
public:
    /// The places in the code, counted in uses, where each number is used.
    using Uses = std::unordered_map<Offset, std::vector<long>>;

    /// @param known null the first time
    NativeRegisters(x86::Assembler& assembler, std::size_t count, const Uses* known)
        : assembler_(assembler), count_(count), known_(known) {
        held_.fill(no_offset);
    }

    /// Returns the memory at an offset.
    static x86::Mem memory(Offset offset) {
        return offset >= scratch_begin ? x86::ptr(x86::rsi, static_cast<int>((offset - scratch_begin) * 8))
                                       : x86::ptr(x86::rdi, static_cast<int>(offset * 8));
    }
    /// Returns a register for a result, which keeps it until the end of the step.
    x86::Xmm fresh();
    /// Returns a register that holds the number until two others are asked for.
    x86::Xmm load(Offset number);
    /// Calls the function with a register that holds the number, or else with its memory.
    template <class Function>
    void with(Offset number, Function&& function) {
        if (const std::size_t reg = find(number); reg < count_) {
            note_use(number, reg);
            function(x86::xmm(static_cast<std::uint32_t>(reg)));
        } else {
            note_use(number, reg);
            function(memory(place_of(number)));
        }
    }
    void move(x86::Xmm to, Offset from);
    /// to = a * b
    void multiply(x86::Xmm to, x86::Xmm a, Offset b) {
        with(b, [&](const auto& operand) { assembler_.vmulsd(to, a, operand); });
    }
    /// sum += a * b
    void add_product(x86::Xmm sum, x86::Xmm a, Offset b) {
        with(b, [&](const auto& operand) { assembler_.vfmadd231sd(sum, a, operand); });
    }
    /// A register has received a number. @param stored whether others than the code need it in memory
    void define(Offset number, x86::Xmm value, bool stored);
    /// The number is also in the scratch memory.
    void found_at(Offset number, Offset place);
    /// Forgets what registers hold, as after a call. Nothing may be kept in registers only.
    void forget() { held_.fill(no_offset); }
    /// Frees registers of results that have not become numbers.
    void end_step() { computing_.fill(false); }
    const Uses& uses() const { return uses_; }

private:
    std::size_t find(Offset number) const;
    void note_use(Offset number, std::size_t reg);
    long next_use(Offset number) const;
    std::size_t choose() const;
    Offset place_of(Offset number) const {
        const auto found = places_.find(number);
        return found != places_.end() ? found->second : number;
    }

    x86::Assembler& assembler_;
    std::size_t count_;
    const Uses* known_;
    Uses uses_;
    std::array<Offset, 16> held_{};
    std::array<bool, 16> unstored_{};  ///< whether the number is in the register only
    std::array<bool, 16> computing_{}; ///< whether it has a result that is no number yet
    std::array<long, 16> touched_{};
    long now_ = 0, use_ = 0;
    std::unordered_map<Offset, Offset> places_; ///< of numbers that are only in the scratch memory
};

} // namespace graze
