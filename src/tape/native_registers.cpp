#include "tape/native_registers.hpp"

#include <algorithm>
#include <limits>

namespace graze {

namespace {

constexpr long never = std::numeric_limits<long>::max();
/// Registers touched since are not chosen: an instruction is about to use them.
constexpr long lasting = 3;

} // namespace

std::size_t NativeRegisters::find(Offset number) const {
    const auto end = held_.begin() + static_cast<std::ptrdiff_t>(count_);
    return static_cast<std::size_t>(std::find(held_.begin(), end, number) - held_.begin());
}

void NativeRegisters::note_use(Offset number, std::size_t reg) {
    uses_[number].push_back(++use_);
    if (reg < count_)
        touched_[reg] = ++now_;
}

/// Returns `never` if there is none.
long NativeRegisters::next_use(Offset number) const {
    if (known_ == nullptr)
        return never;
    const auto found = known_->find(number);
    if (found == known_->end())
        return never;
    const auto next = std::ranges::upper_bound(found->second, use_);
    return next != found->second.end() ? *next : never;
}

/// Chooses the register whose number is not used for longest.
std::size_t NativeRegisters::choose() const {
    std::size_t best = 0;
    long latest = -1;
    for (std::size_t reg = 0; reg < count_; ++reg) {
        if (computing_[reg])
            continue;
        if (held_[reg] == no_offset)
            return reg;
        if (touched_[reg] != 0 && touched_[reg] > now_ - lasting)
            continue;
        if (const long next = next_use(held_[reg]); next > latest) {
            latest = next;
            best = reg;
        }
    }
    return best;
}

x86::Xmm NativeRegisters::fresh() {
    const std::size_t reg = choose();
    const x86::Xmm result = x86::xmm(static_cast<std::uint32_t>(reg));
    if (unstored_[reg] && next_use(held_[reg]) != never)
        assembler_.vmovsd(memory(held_[reg]), result);
    unstored_[reg] = false;
    held_[reg] = no_offset;
    computing_[reg] = true;
    touched_[reg] = ++now_;
    return result;
}

x86::Xmm NativeRegisters::load(Offset number) {
    const std::size_t found = find(number);
    note_use(number, found);
    if (found < count_)
        return x86::xmm(static_cast<std::uint32_t>(found));
    const x86::Xmm reg = fresh();
    assembler_.vmovsd(reg, memory(place_of(number)));
    held_[reg.id()] = number;
    computing_[reg.id()] = false;
    return reg;
}

void NativeRegisters::move(x86::Xmm to, Offset from) {
    const std::size_t found = find(from);
    note_use(from, found);
    if (found < count_)
        assembler_.vmovapd(to, x86::xmm(static_cast<std::uint32_t>(found)));
    else
        assembler_.vmovsd(to, memory(place_of(from)));
}

void NativeRegisters::define(Offset number, x86::Xmm value, bool stored) {
    held_[value.id()] = number;
    touched_[value.id()] = ++now_;
    computing_[value.id()] = false;
    if (stored)
        assembler_.vmovsd(memory(number), value);
    unstored_[value.id()] = !stored;
}

void NativeRegisters::found_at(Offset number, Offset place) {
    const std::size_t reg = find(number);
    if (reg >= count_ || !unstored_[reg])
        return;
    unstored_[reg] = false;
    places_[number] = place;
}

} // namespace graze
