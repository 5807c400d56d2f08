#pragma once

#include "tape/native_registers.hpp"

#include <optional>
#include <span>

namespace graze {

/// Two series of which convolutions are needed: a_j b_{k-j}, for 0 < j < k or, if they are the same, for 0 < j < k/2.
struct NativeProduct {
    Offset a, b;
    bool half;
};
/// Returns the product that a step sums, if any.
std::optional<NativeProduct> product_of(const NativeStep& step);

/// Generates the sums of products of coefficients, those of order 1 and of the last order excepted. The products of
/// several series are side by side in a register, a group. For this the coefficients of each order are gathered in
/// registers. The sums have the same terms in the same order as those of the kernels.
class NativeSums {
public:
    /// @param wide registers of 8 numbers, with masks, instead of 4
    /// @param caches whether registers may hold coefficients over many orders
    NativeSums(x86::Assembler& assembler, NativeRegisters& registers, std::span<const NativeStep> steps, int highest,
               bool wide, bool caches, Offset begin);

    /// Gathers the coefficients of an order, which are known now.
    void gather(int order);
    /// Generates the sums for an order, for which coefficients up to two orders below have been gathered.
    void add_up(int order);
    /// Returns where the sum of a product is; nothing if it is not among those of the highest order.
    std::optional<Offset> place(const NativeProduct& product, int order) const;
    Offset end() const { return sums_ + 2 * groups() * width_; } ///< of its part of the scratch memory

private:
    Offset groups() const { return (static_cast<Offset>(products_.size()) + width_ - 1) / width_; }
    Offset group_size() const { return 2 * (highest_ + 1) * width_; }
    Offset gathered(Offset group, bool second, int order) const {
        return begin_ + group * group_size() + ((second ? highest_ + 1 : 0) + order) * width_;
    }
    Offset sum_of(Offset group, int order) const { return sums_ + ((order % 2) * groups() + group) * width_; }
    x86::Vec vector(int index) const {
        const auto id = static_cast<std::uint32_t>(index);
        return width_ == 8 ? static_cast<x86::Vec>(x86::zmm(id)) : static_cast<x86::Vec>(x86::ymm(id));
    }
    void find_products(std::span<const NativeStep> steps);
    std::span<const NativeProduct> of_group(Offset group) const;
    void gather(Offset group, bool second, int order);
    x86::Xmm pair(int to, std::span<const NativeProduct> lanes, std::size_t lane, bool second, int order);
    void join(std::uint32_t to, std::uint32_t other);
    void add_up(Offset group, int order);
    void multiply_add(int sum, Offset group, int j, int order, bool first, bool masked);
    std::optional<int> cached(Offset group, bool second, int order) const;

    x86::Assembler& assembler_;
    NativeRegisters& registers_;
    int highest_, width_, temporary_, first_sum_, free_cache_ = 0, end_of_cache_ = 0;
    Offset begin_, sums_;
    std::vector<NativeProduct> products_;
    std::map<Offset, int> cache_; ///< registers of gathered coefficients
};

} // namespace graze
