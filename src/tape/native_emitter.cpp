#include "tape/native_emitter.hpp"

#include "tape/kernel_program.hpp"

#include <algorithm>

namespace graze {

namespace {

using Kind = NativeStep::Kind;

const KernelLink end_link{.kernel = end_of_chain};

bool calls_kernels(std::span<const NativeStep> steps) {
    return std::ranges::any_of(steps, [](const NativeStep& step) { return step.kind == Kind::other; });
}

bool has_slot(const NativeStep& step) {
    return step.kind == Kind::divide || step.kind == Kind::reciprocal || step.kind == Kind::square;
}

Offset slots_in(std::span<const NativeStep> steps) {
    return std::ranges::count_if(steps, [](const NativeStep& step) { return step.order == 2 && has_slot(step); });
}

} // namespace

NativeEmitter::NativeEmitter(const Setting& setting, const NativeRegisters::Uses* known)
    : steps_(setting.steps), highest_(setting.highest), stored_(setting.stored),
      stores_all_(steps_.empty() || steps_.front().order < 2 || calls_kernels(steps_)), first_call_(setting.first_call),
      registers_(assembler_, setting.wide ? 14 : 9, known),
      sums_(assembler_, registers_, steps_, highest_, setting.wide, !stores_all_, first_slot + slots_in(steps_)) {
    code_.init(asmjit::Environment::host());
    code_.setErrorHandler(&errors_);
    code_.attach(&assembler_);
    for (const NativeStep& step : steps_)
        if (step.order == 2 && has_slot(step))
            slots_[step.result] = first_slot + static_cast<Offset>(slots_.size());
}

std::span<const std::uint8_t> NativeEmitter::code() const {
    const asmjit::CodeBuffer& buffer = code_.textSection()->buffer();
    return {buffer.data(), buffer.size()};
}

void NativeEmitter::emit() {
    emit_beginning();
    int order = 1;
    for (const NativeStep& step : steps_) {
        if (step.order < 2) {
            emit_first_orders(step);
            registers_.end_step();
            continue;
        }
        if (step.order != order) {
            if (order >= 2 && order <= highest_ - 2)
                sums_.gather(order);
            order = step.order;
            if (order < highest_)
                sums_.add_up(order + 1);
        }
        emit(step);
        registers_.end_step();
    }
    assembler_.vzeroupper();
    for (const x86::Gp& reg : {x86::r13, x86::r12, x86::rbx})
        assembler_.pop(reg);
    assembler_.ret();
}

/// Saves registers, and computes the numbers by which all coefficients of some series are multiplied.
void NativeEmitter::emit_beginning() {
    for (const x86::Gp& reg : {x86::rbx, x86::r12, x86::r13})
        assembler_.push(reg);
    assembler_.mov(x86::rbx, x86::rdi);
    assembler_.mov(x86::r12, x86::rsi);
    assembler_.mov(x86::r13, x86::rdx);
    for (const NativeStep& step : steps_) {
        if (step.order != 2 || !has_slot(step))
            continue;
        const x86::Xmm value = copy_of(step.kind == Kind::square ? step.left : step.result);
        if (step.kind == Kind::square)
            assembler_.vaddsd(value, value, value);
        else
            registers_.multiply(value, value, step.kind == Kind::divide ? step.third : step.result);
        assembler_.vmovsd(NativeRegisters::memory(scratch_begin + slots_.at(step.result)), value);
        registers_.end_step();
    }
}

x86::Xmm NativeEmitter::copy_of(Offset number) {
    const x86::Xmm copy = registers_.fresh();
    registers_.move(copy, number);
    return copy;
}

/// Returns (a b) c.
x86::Xmm NativeEmitter::product_of_three(Offset a, Offset b, Offset c) {
    const x86::Xmm value = copy_of(a);
    registers_.multiply(value, value, b);
    registers_.multiply(value, value, c);
    return value;
}

x86::Xmm NativeEmitter::convolution(const NativeProduct& product, int order) {
    const auto [a, b, half] = product;
    const x86::Xmm sum = copy_of(a + 1);
    const Offset last = b + order - 1;
    const int inner = half ? (order - 1) / 2 - 1 : order - 3;
    if (inner <= 0) {
        registers_.multiply(sum, sum, last);
    } else if (const std::optional<Offset> place = sums_.place(product, order)) {
        assembler_.vfmadd213sd(sum, registers_.load(last), NativeRegisters::memory(*place));
    } else { // a product of low degree, and so of order 4: there is one term
        const x86::Xmm middle = copy_of(a + 2);
        registers_.multiply(middle, middle, b + 2);
        assembler_.vfmadd213sd(sum, registers_.load(last), middle);
    }
    if (!half && order > 2)
        registers_.add_product(sum, registers_.load(a + order - 1), b + 1);
    return sum;
}

/// Returns the sum of a_j a_{k-j}, 0 < j < k.
x86::Xmm NativeEmitter::self_convolution(const NativeStep& step) {
    const NativeProduct product = *product_of(step);
    if (step.order == 2) {
        const x86::Xmm middle = copy_of(product.a + 1);
        assembler_.vmulsd(middle, middle, middle);
        return middle;
    }
    const x86::Xmm sum = convolution(product, step.order);
    assembler_.vaddsd(sum, sum, sum);
    if (step.order % 2 == 0) {
        const x86::Xmm middle = registers_.load(product.a + step.order / 2);
        assembler_.vfmadd231sd(sum, middle, middle);
    }
    return sum;
}

x86::Xmm NativeEmitter::linear_sum(const NativeStep& step, int order) {
    if (step.terms.empty() || step.terms.size() >= combination_kernels)
        return long_sum(step, order);
    const x86::Xmm sum = copy_of(step.terms[0].coefficient);
    registers_.multiply(sum, sum, step.terms[0].series + order);
    for (std::size_t i = 1; i < step.terms.size(); ++i)
        registers_.add_product(sum, registers_.load(step.terms[i].series + order), step.terms[i].coefficient);
    return sum;
}

/// The same with four partial sums, in the order of the kernels.
x86::Xmm NativeEmitter::long_sum(const NativeStep& step, int order) {
    std::array<x86::Xmm, 4> sums;
    for (x86::Xmm& one : sums) {
        one = registers_.fresh();
        assembler_.vxorpd(one, one, one);
    }
    const auto add = [&](std::size_t i, x86::Xmm sum) {
        registers_.add_product(sum, registers_.load(step.terms[i].series + order), step.terms[i].coefficient);
    };
    std::size_t i = 0;
    for (; step.terms.size() - i >= sums.size(); i += sums.size())
        for (std::size_t j = 0; j < sums.size(); ++j)
            add(i + j, sums[j]);
    assembler_.vaddsd(sums[0], sums[0], sums[1]);
    assembler_.vaddsd(sums[2], sums[2], sums[3]);
    assembler_.vaddsd(sums[0], sums[0], sums[2]);
    for (; i < step.terms.size(); ++i)
        add(i, sums[0]);
    return sums[0];
}

void NativeEmitter::emit_product(const NativeStep& step) {
    const int k = step.order;
    if (step.kind == Kind::square) {
        const x86::Xmm sum = self_convolution(step);
        registers_.add_product(sum, registers_.load(step.left + k), scratch_begin + slots_.at(step.result));
        return define(step, sum);
    }
    const x86::Xmm sum = convolution(*product_of(step), k);
    registers_.add_product(sum, registers_.load(step.left + k), step.right);
    registers_.add_product(sum, registers_.load(step.right + k), step.left);
    define(step, sum);
}

/// q_k = a_k / b_0 - (q_0 / b_0) b_k - sum / b_0
void NativeEmitter::emit_quotient(const NativeStep& step) {
    const int k = step.order;
    const bool reciprocal = step.kind == Kind::reciprocal;
    const NativeProduct product = *product_of(step);
    const x86::Xmm sum = convolution(product, k);
    registers_.multiply(sum, sum, reciprocal ? step.result : step.third);
    const x86::Xmm divisor = registers_.load(product.b + k);
    const x86::Xmm value = copy_of(scratch_begin + slots_.at(step.result));
    assembler_.vfnmsub213sd(value, divisor, sum);
    if (!reciprocal)
        registers_.add_product(value, registers_.load(step.left + k), step.third);
    define(step, value);
}

/// y_k = (a_k - sum) / (2 y_0)
void NativeEmitter::emit_root(const NativeStep& step) {
    const x86::Xmm sum = self_convolution(step);
    registers_.multiply(sum, sum, step.third);
    const x86::Xmm slope = registers_.load(step.third);
    const x86::Xmm value = copy_of(step.left + step.order);
    assembler_.vfmsub213sd(value, slope, sum);
    define(step, value);
}

void NativeEmitter::emit_function(const NativeStep& step) {
    const x86::Xmm sum = convolution(*product_of(step), step.order);
    registers_.multiply(sum, sum, inverse_of(step));
    const x86::Xmm argument = registers_.load(step.third + step.order);
    registers_.with(step.right, [&](const auto& operand) {
        if (step.negative)
            assembler_.vfnmadd231sd(sum, argument, operand);
        else
            assembler_.vfmadd231sd(sum, argument, operand);
    });
    define(step, sum);
}

/// Steps without products of two series of unbounded degree.
void NativeEmitter::emit_linear(const NativeStep& step) {
    const int k = step.order;
    switch (step.kind) {
    case Kind::state: {
        const x86::Xmm value = copy_of(step.left + k - 1);
        registers_.multiply(value, value, inverse_of(step));
        return define(step, value);
    }
    case Kind::state_combination: {
        const x86::Xmm value = linear_sum(step, k - 1);
        registers_.multiply(value, value, inverse_of(step));
        return define(step, value);
    }
    case Kind::function_of_linear:
        return define(step, product_of_three(step.third + 1, inverse_of(step), step.right + k - 1));
    case Kind::multiply_linear: {
        const x86::Xmm value = copy_of(step.left + 1);
        registers_.multiply(value, value, step.right + k - 1);
        registers_.add_product(value, registers_.load(step.right + k), step.left);
        return define(step, value);
    }
    case Kind::exponential:
        return define(step, product_of_three(step.left + 1, inverse_of(step), step.result + k - 1));
    default: { // a quotient function, or a derivative
        const x86::Xmm value = copy_of(step.left + k);
        registers_.multiply(value, value,
                            step.kind == Kind::derivative ? scratch_begin + integers + k : inverse_of(step));
        define(step, value);
    }
    }
}

void NativeEmitter::emit_pair(const NativeStep& step) {
    const int k = step.order;
    const x86::Xmm one = product_of_three(step.left + 1, scratch_begin + inverses + k, step.third + k - 1);
    const x86::Xmm other = product_of_three(step.left + 1, inverse_of(step), step.result + k - 1);
    define(step, one);
    define(step.third, k, other);
}

void NativeEmitter::emit_call(const NativeStep& step) {
    const auto index = static_cast<std::int32_t>((first_call_ + calls_.size()) * sizeof(KernelOperands));
    assembler_.lea(x86::rdi, x86::ptr(x86::r13, index));
    assembler_.mov(x86::rsi, reinterpret_cast<std::uint64_t>(&end_link));
    assembler_.mov(x86::edx, step.order);
    assembler_.mov(x86::rax, reinterpret_cast<std::uint64_t>(step.kernel));
    assembler_.vzeroupper();
    assembler_.call(x86::rax);
    assembler_.mov(x86::rdi, x86::rbx);
    assembler_.mov(x86::rsi, x86::r12);
    registers_.forget();
    calls_.push_back(step);
}

/// Returns -(a b).
x86::Xmm NativeEmitter::minus_product(Offset a, x86::Xmm b) {
    const x86::Xmm value = registers_.fresh();
    assembler_.vxorpd(value, value, value);
    registers_.with(a, [&](const auto& operand) { assembler_.vfnmsub231sd(value, b, operand); });
    return value;
}

void NativeEmitter::emit_first_orders(const NativeStep& step) {
    using enum NativeStep::Kind;
    const int k = step.order;
    switch (step.kind) {
    case combination:
    case state_combination: {
        const x86::Xmm value = linear_sum(step, step.kind == combination ? k : 0);
        if (k == 0 || step.kind == state_combination)
            registers_.with(step.right, [&](const auto& operand) { assembler_.vaddsd(value, value, operand); });
        return define(step, value);
    }
    case multiply:
    case square:
    case divide:
    case reciprocal:
    case square_root:
    case derivative:
    case function_by_product:
        return k == 0 ? emit_value(step) : emit_slope(step);
    case other:
        return emit_call(step);
    default:
        return emit_linear(step);
    }
}

/// Order 0.
void NativeEmitter::emit_value(const NativeStep& step) {
    constexpr Offset one = scratch_begin + inverses + 1, half = scratch_begin + inverses + 2;
    const auto divide = [&](x86::Xmm a, Offset b) {
        registers_.with(b, [&](const auto& operand) { assembler_.vdivsd(a, a, operand); });
    };
    switch (step.kind) {
    case Kind::multiply:
    case Kind::square: {
        const x86::Xmm value = copy_of(step.left);
        registers_.multiply(value, value, step.kind == Kind::square ? step.left : step.right);
        return define(step, value);
    }
    case Kind::divide: {
        const x86::Xmm inverse = copy_of(one);
        divide(inverse, step.right);
        const x86::Xmm value = copy_of(step.left);
        divide(value, step.right);
        registers_.define(step.third, inverse, true);
        return define(step, value);
    }
    case Kind::reciprocal: {
        const x86::Xmm value = copy_of(one);
        divide(value, step.left);
        return define(step, value);
    }
    case Kind::square_root: {
        const x86::Xmm root = copy_of(step.left);
        assembler_.vsqrtsd(root, root, root);
        const x86::Xmm slope = copy_of(half);
        assembler_.vdivsd(slope, slope, root);
        registers_.define(step.third, slope, true);
        return define(step, root);
    }
    default: { // a derivative
        const x86::Xmm zero = registers_.fresh();
        assembler_.vxorpd(zero, zero, zero);
        define(step, zero);
    }
    }
}

/// Order 1.
void NativeEmitter::emit_slope(const NativeStep& step) {
    const x86::Xmm value = copy_of((step.kind == Kind::function_by_product ? step.third : step.left) + 1);
    switch (step.kind) {
    case Kind::multiply:
        registers_.multiply(value, value, step.right);
        registers_.add_product(value, registers_.load(step.left), step.right + 1);
        return define(step, value);
    case Kind::square: {
        const x86::Xmm twice = copy_of(step.left);
        assembler_.vaddsd(twice, twice, twice);
        assembler_.vmulsd(value, value, twice);
        return define(step, value);
    }
    case Kind::divide: {
        const x86::Xmm part = copy_of(step.result);
        registers_.multiply(part, part, step.third);
        registers_.multiply(part, part, step.right + 1);
        assembler_.vfmsub213sd(value, registers_.load(step.third), part);
        return define(step, value);
    }
    case Kind::reciprocal: {
        const x86::Xmm slope = copy_of(step.result);
        assembler_.vmulsd(slope, slope, slope);
        return define(step, minus_product(step.left + 1, slope));
    }
    case Kind::square_root:
        registers_.multiply(value, value, step.third);
        return define(step, value);
    case Kind::function_by_product:
        if (step.negative)
            return define(step, minus_product(step.right, value));
        registers_.multiply(value, value, step.right);
        return define(step, value);
    default: // a derivative
        return define(step, value);
    }
}

void NativeEmitter::emit(const NativeStep& step) {
    switch (step.kind) {
    case Kind::combination:
        return define(step, linear_sum(step, step.order));
    case Kind::multiply:
    case Kind::square:
        return emit_product(step);
    case Kind::divide:
    case Kind::reciprocal:
        return emit_quotient(step);
    case Kind::square_root:
        return emit_root(step);
    case Kind::function_by_product:
        return emit_function(step);
    case Kind::pair:
        return emit_pair(step);
    case Kind::other:
        return emit_call(step);
    default:
        return emit_linear(step);
    }
}

} // namespace graze
