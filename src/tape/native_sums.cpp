#include "tape/native_sums.hpp"

#include <algorithm>

namespace graze {

namespace {

constexpr NativeProduct no_product{no_offset, no_offset, false};

} // namespace

std::optional<NativeProduct> product_of(const NativeStep& step) {
    using Kind = NativeStep::Kind;
    switch (step.kind) {
    case Kind::multiply:
    case Kind::function_by_product:
        return NativeProduct{step.left, step.right, false};
    case Kind::divide:
        return NativeProduct{step.result, step.right, false};
    case Kind::reciprocal:
        return NativeProduct{step.result, step.left, false};
    case Kind::square:
        return NativeProduct{step.left, step.left, true};
    case Kind::square_root:
        return NativeProduct{step.result, step.result, true};
    default:
        return std::nullopt;
    }
}

NativeSums::NativeSums(x86::Assembler& assembler, NativeRegisters& registers, std::span<const NativeStep> steps,
                       int highest, bool wide, bool caches, Offset begin)
    : assembler_(assembler), registers_(registers), highest_(highest), width_(wide ? 8 : 4), temporary_(wide ? 24 : 9),
      first_sum_(wide ? 28 : 12), begin_((begin + 7) / 8 * 8) {
    if (wide && caches) {
        free_cache_ = 14;
        end_of_cache_ = 24;
    }
    find_products(steps);
    sums_ = begin_ + groups() * group_size();
}

/// Squares need half of the terms. Without masks they are in groups of their own.
void NativeSums::find_products(std::span<const NativeStep> steps) {
    for (const bool half : {false, true}) {
        for (const NativeStep& step : steps)
            if (step.order == highest_)
                if (const auto product = product_of(step); product && product->half == half)
                    products_.push_back(*product);
        while (width_ == 4 && !half && products_.size() % 4 != 0)
            products_.push_back(no_product);
    }
}

std::span<const NativeProduct> NativeSums::of_group(Offset group) const {
    const std::span<const NativeProduct> from = std::span(products_).subspan(static_cast<std::size_t>(group * width_));
    return from.first(std::min(from.size(), static_cast<std::size_t>(width_)));
}

std::optional<Offset> NativeSums::place(const NativeProduct& product, int order) const {
    const auto found = std::ranges::find_if(products_, [&](const NativeProduct& one) {
        return one.a == product.a && one.b == product.b && one.half == product.half;
    });
    if (found == products_.end())
        return std::nullopt;
    const Offset lane = found - products_.begin();
    return scratch_begin + sum_of(lane / width_, order) + lane % width_;
}

std::optional<int> NativeSums::cached(Offset group, bool second, int order) const {
    const auto found = cache_.find(gathered(group, second, order));
    return found != cache_.end() ? std::optional(found->second) : std::nullopt;
}

void NativeSums::gather(int order) {
    for (Offset group = 0; group < groups(); ++group)
        for (const bool second : {false, true})
            gather(group, second, order);
}

/// Puts the coefficients of two lanes into a register. (What is in lanes without product does not matter.)
x86::Xmm NativeSums::pair(int to, std::span<const NativeProduct> lanes, std::size_t lane, bool second, int order) {
    const auto number = [&](std::size_t index) {
        const NativeProduct& product = lanes[std::min(index, lanes.size() - 1)];
        return (second ? product.b : product.a) + order;
    };
    const x86::Xmm both = x86::xmm(static_cast<std::uint32_t>(to));
    if (lanes[std::min(lane, lanes.size() - 1)].a == no_offset) {
        assembler_.vxorpd(both, both, both);
        return both;
    }
    x86::Xmm low = both;
    registers_.with(number(lane), [&](const auto& operand) {
        if constexpr (std::is_same_v<std::decay_t<decltype(operand)>, x86::Mem>)
            assembler_.vmovsd(both, operand);
        else
            low = operand;
    });
    if (lane + 1 >= lanes.size() || lanes[lane + 1].a == no_offset) {
        assembler_.vunpcklpd(both, low, low);
        return both;
    }
    registers_.with(number(lane + 1), [&](const auto& operand) {
        if constexpr (std::is_same_v<std::decay_t<decltype(operand)>, x86::Mem>)
            assembler_.vmovhpd(both, low, operand);
        else
            assembler_.vunpcklpd(both, low, operand);
    });
    return both;
}

/// Puts the two numbers of another register behind those of the first.
void NativeSums::join(std::uint32_t to, std::uint32_t other) {
    if (width_ == 8)
        assembler_.vinsertf32x4(x86::ymm(to), x86::ymm(to), x86::xmm(other), 1);
    else
        assembler_.vinsertf128(x86::ymm(to), x86::ymm(to), x86::xmm(other), 1);
}

void NativeSums::gather(Offset group, bool second, int order) {
    const std::span<const NativeProduct> lanes = of_group(group);
    const auto id = [&](int index) { return static_cast<std::uint32_t>(temporary_ + index); };
    const Offset to = gathered(group, second, order);
    std::uint32_t result = id(0);
    if (free_cache_ < end_of_cache_) {
        cache_[to] = free_cache_;
        result = static_cast<std::uint32_t>(free_cache_++);
    }
    pair(temporary_, lanes, 0, second, order);
    if (lanes.size() > 2) {
        pair(temporary_ + 1, lanes, 2, second, order);
        join(id(0), id(1));
    }
    if (lanes.size() > 4) {
        pair(temporary_ + 1, lanes, 4, second, order);
        if (lanes.size() > 6) {
            pair(temporary_ + 2, lanes, 6, second, order);
            join(id(1), id(2));
        }
        assembler_.vinsertf64x4(x86::zmm(result), x86::zmm(id(0)), x86::ymm(id(1)), 1);
    } else if (result != id(0)) {
        assembler_.vmovapd(x86::ymm(result), x86::ymm(id(0)));
    }
    assembler_.vmovupd(NativeRegisters::memory(scratch_begin + to), vector(static_cast<int>(result)));
    for (std::size_t lane = 0; lane < lanes.size(); ++lane)
        if (lanes[lane].a != no_offset)
            registers_.found_at((second ? lanes[lane].b : lanes[lane].a) + order,
                                scratch_begin + to + static_cast<Offset>(lane));
}

void NativeSums::add_up(int order) {
    for (Offset group = 0; group < groups(); ++group)
        add_up(group, order);
}

/// Adds a_j b_{order-j}.
void NativeSums::multiply_add(int sum, Offset group, int j, int order, bool first, bool masked) {
    std::optional<int> one = cached(group, false, j);
    const std::optional<int> other = cached(group, true, order - j);
    const auto memory = [&](bool second, int k) {
        return NativeRegisters::memory(scratch_begin + gathered(group, second, k));
    };
    if (!one && !other) {
        assembler_.vmovupd(vector(temporary_ + 3 - (width_ == 4 ? 1 : 0)), memory(false, j));
        one = temporary_ + 3 - (width_ == 4 ? 1 : 0);
    }
    const x86::Vec to = vector(sum), factor = vector(one ? *one : *other);
    const auto emit = [&](const auto& operand) {
        if (first)
            assembler_.vmulpd(to, factor, operand);
        else if (masked)
            assembler_.k(x86::k1).vfmadd231pd(to, factor, operand);
        else
            assembler_.vfmadd231pd(to, factor, operand);
    };
    if (one && other)
        emit(vector(*other));
    else
        emit(one ? memory(true, order - j) : memory(false, j));
}

void NativeSums::add_up(Offset group, int order) {
    unsigned full_lanes = 0, half_lanes = 0, lane = 1;
    for (const NativeProduct& product : of_group(group)) {
        (product.half ? half_lanes : full_lanes) |= lane;
        lane *= 2;
    }
    const int full = full_lanes != 0 ? std::max(order - 3, 0) : 0;
    const int half = half_lanes != 0 ? std::max((order - 1) / 2 - 1, 0) : 0;
    const int terms = std::max(full, half);
    if (terms == 0)
        return;
    const bool mixed = full_lanes != 0 && half_lanes != 0;
    const auto excludes_half = [&](int needed) { return mixed && half < needed; };
    if (mixed) {
        assembler_.mov(x86::eax, full_lanes);
        assembler_.kmovb(x86::k1, x86::eax);
    }
    // Partial sums as in the kernels: see `accumulate` and `total`.
    for (int i = 0; i < terms; ++i)
        multiply_add(first_sum_ + i % 4, group, i + 2, order, i < 4, excludes_half(i + 1));
    const auto add = [&](int to, int from, int needed) {
        const x86::Vec sum = vector(first_sum_ + to);
        if (excludes_half(needed))
            assembler_.k(x86::k1).vaddpd(sum, sum, vector(first_sum_ + from));
        else
            assembler_.vaddpd(sum, sum, vector(first_sum_ + from));
    };
    if (terms >= 4)
        add(2, 3, 4);
    if (terms >= 2)
        add(0, 1, 2);
    if (terms >= 3)
        add(0, 2, 3);
    assembler_.vmovupd(NativeRegisters::memory(scratch_begin + sum_of(group, order)), vector(first_sum_));
}

} // namespace graze
