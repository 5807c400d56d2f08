#pragma once

#include "graze/tape/jet.hpp"
#include "graze/tape/tape.hpp"
#include "tape/aligned_numbers.hpp"
#include "tape/kernel_table.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

namespace graze {

/// Machine code for the coefficients of a tape, for a single lane. It computes what the kernels
/// do, bit for bit. Immutable; it is in pages of memory that can be executed but no longer written.
class NativeCode {
public:
    /// Makes the code. Null where none can be made (on another processor, where memory may not be executed, or in a
    /// build without the assembler), or where it would be too long.
    /// @param table the kernels of the instruction set
    static std::shared_ptr<const NativeCode> make(const Tape& tape, int order, const KernelTable& table,
                                                  InstructionSet set);
    ~NativeCode();
    NativeCode(const NativeCode&) = delete;
    NativeCode& operator=(const NativeCode&) = delete;

    /// Number of doubles that the code needs besides the memory of a jet, initially 0.
    std::size_t scratch() const { return scratch_; }
    /// Sets the constants in the scratch memory.
    void prepare(double* scratch) const;
    /// Operands of the kernels that the code calls, in the memory of a jet.
    std::vector<KernelOperands> calls(double* memory) const;
    /// Computes the coefficients of orders 0 and 1 from the values of the states.
    void begin(double* memory, double* scratch, const KernelOperands* calls) const {
        beginning_(memory, scratch, calls);
    }
    /// Computes all others, given those of orders 0 and 1.
    void go_on(double* memory, double* scratch, const KernelOperands* calls) const { rest_(memory, scratch, calls); }
    std::size_t size() const { return size_; } ///< bytes

private:
    NativeCode() = default;
    bool store(std::span<const std::uint8_t> beginning, std::span<const std::uint8_t> rest);

    using Entry = void (*)(double* memory, double* scratch, const KernelOperands* calls);
    struct Call {
        std::ptrdiff_t result, left, right, third;
    };
    Entry beginning_ = nullptr, rest_ = nullptr;
    void* pages_ = nullptr;
    std::size_t size_ = 0, scratch_ = 0;
    std::vector<Call> calls_;
};

/// The machine code of a tape, made when the jets of the tape have computed so often that it pays. Copies of a tape
/// share it; thread-safe.
class NativeCodes {
public:
    /// Jets report their computations in such portions.
    static constexpr int portion = 256;

    /// @param tape is copied
    explicit NativeCodes(const Tape& tape) : tape_(tape) { tape_.native_codes = nullptr; }

    /// Returns the code for an order if it has been made. If not, a portion of computations is noted, and the code is
    /// made if they have become many. @param now make it in any case
    std::shared_ptr<const NativeCode> after_portion(int order, InstructionSet set, bool now);
    /// Returns the code if it has been made; null otherwise.
    std::shared_ptr<const NativeCode> find(int order, InstructionSet set);

private:
    struct Entry {
        std::size_t computed = 0;
        bool tried = false;
        std::shared_ptr<const NativeCode> code;
    };
    Tape tape_;
    std::mutex mutex_; ///< of the entries
    std::map<std::pair<int, InstructionSet>, Entry> entries_;
};

/// A jet's use of machine code.
class NativeRun {
public:
    NativeRun(std::shared_ptr<const NativeCode> code, double* memory);
    void begin() const { code_->begin(memory_, scratch_.data(), calls_.data()); }
    void go_on() const { code_->go_on(memory_, scratch_.data(), calls_.data()); }

private:
    std::shared_ptr<const NativeCode> code_;
    double* memory_;
    AlignedNumbers scratch_;
    std::vector<KernelOperands> calls_;
};

} // namespace graze
