#include "tape/series_builder.hpp"

#include "symbolic/function_table.hpp"

#include <cmath>
#include <utility>

namespace graze {

namespace {

/// Longer sums are split, so that building them takes linear time.
constexpr std::size_t most_terms = 64;
/// Longer sums are computed before they are multiplied by a constant that is not a literal.
constexpr std::size_t most_scaled_terms = 4;
/// Larger exponents are not reached by repeated squaring.
constexpr double highest_integer_power = 1 << 20;

} // namespace

SeriesBuilder::SeriesBuilder(std::uint32_t states, std::uint32_t parameters)
    : registers_(states), constants_(parameters), zero_(constants_.literal(0)), one_(constants_.literal(1)) {}

void SeriesBuilder::move_to(Tape& tape) {
    tape.registers = registers_;
    tape.code = std::move(code_);
    tape.terms = std::move(terms_);
}

LinearForm SeriesBuilder::apply(Operation operation, LinearForm left, LinearForm right) {
    const bool binary = arity(operation) == 2;
    if (left.is_constant() && (!binary || right.is_constant()))
        return constant(constants_.apply(operation, left.constant, right.constant));
    switch (operation) {
    case Operation::add:
        return add(std::move(left), std::move(right));
    case Operation::subtract:
        return add(std::move(left), scale(std::move(right), constants_.literal(-1)));
    case Operation::negate:
        return scale(std::move(left), constants_.literal(-1));
    case Operation::multiply:
        return multiply(std::move(left), std::move(right));
    case Operation::divide:
        return divide(std::move(left), right);
    case Operation::power:
        return power(std::move(left), std::move(right));
    default:
        return function(operation, reg_of(left));
    }
}

LinearForm SeriesBuilder::shared(LinearForm form) {
    return form.terms.size() < 2 ? std::move(form) : series(reg_of(form));
}

Tape::Location SeriesBuilder::location(const LinearForm& form) {
    return form.is_constant() ? Tape::Location{true, form.constant} : Tape::Location{false, reg_of(form)};
}

LinearForm SeriesBuilder::add(LinearForm left, LinearForm right) {
    if (left.terms.size() > most_terms)
        left = series(reg_of(left));
    if (right.terms.size() > most_terms)
        right = series(reg_of(right));
    LinearForm sum{constants_.apply(Operation::add, left.constant, right.constant), {}};
    sum.terms.reserve(left.terms.size() + right.terms.size());
    auto a = left.terms.begin();
    auto b = right.terms.begin();
    while (a != left.terms.end() || b != right.terms.end()) {
        if (b == right.terms.end() || (a != left.terms.end() && a->series < b->series)) {
            sum.terms.push_back(*a++);
        } else if (a == left.terms.end() || b->series < a->series) {
            sum.terms.push_back(*b++);
        } else {
            const auto coefficient = constants_.apply(Operation::add, a->coefficient, b->coefficient);
            if (coefficient != zero_)
                sum.terms.push_back({a->series, coefficient});
            ++a;
            ++b;
        }
    }
    return sum;
}

LinearForm SeriesBuilder::scale(LinearForm form, std::uint32_t coefficient) {
    if (coefficient == zero_)
        return constant(zero_);
    if (form.terms.size() > most_scaled_terms && !constants_.value_of(coefficient))
        form = series(reg_of(form));
    if (form.constant != zero_)
        form.constant = constants_.apply(Operation::multiply, coefficient, form.constant);
    for (Term& term : form.terms)
        term.coefficient = constants_.apply(Operation::multiply, coefficient, term.coefficient);
    return form;
}

LinearForm SeriesBuilder::multiply(LinearForm left, LinearForm right) {
    if (left.is_constant())
        return scale(std::move(right), left.constant);
    if (right.is_constant())
        return scale(std::move(left), right.constant);
    const Scaled a = split(left);
    const Scaled b = split(right);
    const std::uint32_t coefficient = constants_.apply(Operation::multiply, a.coefficient, b.coefficient);
    return is_moderate(coefficient) ? scaled({coefficient, multiply(a.reg, b.reg)})
                                    : series(multiply(reg_of(left), reg_of(right)));
}

/// Splitting large factors off one product after another could overflow where the products themselves do not.
bool SeriesBuilder::is_moderate(std::uint32_t coefficient) const {
    const double size = std::abs(constants_.value_of(coefficient).value_or(1));
    return size == 0 || (size >= 0x1p-400 && size <= 0x1p400);
}

LinearForm SeriesBuilder::divide(LinearForm left, const LinearForm& right) {
    if (right.is_constant())
        return scale(std::move(left), constants_.apply(Operation::divide, one_, right.constant));
    const Scaled b = split(right);
    if (left.is_constant())
        return scaled({constants_.apply(Operation::divide, left.constant, b.coefficient), reciprocal_of(b.reg)});
    const Scaled a = split(left);
    const std::uint32_t coefficient = constants_.apply(Operation::divide, a.coefficient, b.coefficient);
    if (!is_moderate(coefficient))
        return series(emit(SeriesOperation::divide, reg_of(left), reg_of(right)));
    const std::uint32_t quotient = prefers_reciprocals_ && !is_known(SeriesOperation::divide, a.reg, b.reg)
                                       ? multiply(a.reg, reciprocal_of(b.reg))
                                       : emit(SeriesOperation::divide, a.reg, b.reg);
    return scaled({coefficient, quotient});
}

/// Where reciprocals are preferred, the reciprocal of a square is the square of a reciprocal.
std::uint32_t SeriesBuilder::reciprocal_of(std::uint32_t a) {
    const auto root = roots_.find(a);
    if (!prefers_reciprocals_ || is_known(SeriesOperation::reciprocal, a) || root == roots_.end())
        return emit(SeriesOperation::reciprocal, a);
    const std::uint32_t factor = reciprocal_of(root->second);
    return multiply(factor, factor);
}

LinearForm SeriesBuilder::power(LinearForm base, LinearForm exponent) {
    if (!exponent.is_constant()) {
        if (base.is_constant())
            base = constant(constants_.apply(Operation::log, base.constant));
        else
            base = function(Operation::log, reg_of(base));
        return function(Operation::exp, reg_of(multiply(std::move(exponent), std::move(base))));
    }
    const std::optional<double> value = constants_.value_of(exponent.constant);
    if (value && std::abs(*value) <= highest_integer_power) {
        if (*value == 0)
            return constant(one_);
        if (std::trunc(*value) == *value)
            // A large factor that is split off could overflow in a high power.
            return integer_power(std::abs(*value) < 64 ? split(base) : Scaled{one_, reg_of(base)}, *value);
        if (std::trunc(2 * *value) == 2 * *value)
            return half_integer_power(reg_of(base), *value);
    }
    return series(emit(SeriesOperation::power_constant, reg_of(base), exponent.constant));
}

LinearForm SeriesBuilder::integer_power(Scaled base, double exponent) {
    const auto count = static_cast<std::uint32_t>(std::abs(exponent));
    std::uint32_t bit = 1;
    while (bit <= count / 2)
        bit *= 2;
    // The reciprocal is taken first: near a pole of high order, the reciprocal of a power loses digits in each
    // coefficient.
    const std::uint32_t factor = exponent < 0 ? emit(SeriesOperation::reciprocal, base.reg) : base.reg;
    std::uint32_t result = factor;
    for (bit /= 2; bit != 0; bit /= 2) {
        result = multiply(result, result);
        if ((count & bit) != 0)
            result = multiply(factor, result);
    }
    return scaled({constants_.apply(Operation::power, base.coefficient, constants_.literal(exponent)), result});
}

LinearForm SeriesBuilder::half_integer_power(std::uint32_t base, double exponent) {
    const std::uint32_t root = emit(SeriesOperation::sqrt, base);
    if (exponent == 0.5)
        return series(root);
    if (exponent == -0.5)
        return series(emit(SeriesOperation::reciprocal, root));
    return multiply(integer_power({one_, base}, std::trunc(exponent)),
                    half_integer_power(base, exponent - std::trunc(exponent)));
}

LinearForm SeriesBuilder::function(Operation operation, std::uint32_t a) {
    switch (operation) {
    case Operation::sqrt:
        return series(emit(SeriesOperation::sqrt, a));
    case Operation::exp: {
        const std::uint32_t derivative = emit(SeriesOperation::derivative, a);
        const Key key{static_cast<std::uint32_t>(SeriesOperation::exp), a};
        const auto [found, added] = known_.try_emplace(key, registers_);
        if (added) {
            code_.push_back({SeriesOperation::exp, registers_, derivative, registers_, a});
            ++registers_;
        }
        return series(found->second);
    }
    case Operation::sin:
    case Operation::cos:
        return series(
            hyperbolic_or_circular(SeriesOperation::sin, SeriesOperation::cos, a, operation == Operation::sin));
    case Operation::sinh:
    case Operation::cosh:
        return series(
            hyperbolic_or_circular(SeriesOperation::sinh, SeriesOperation::cosh, a, operation == Operation::sinh));
    case Operation::tan:
    case Operation::tanh:
        return series(tangent(operation, a));
    case Operation::erf: {
        LinearForm bell = function(Operation::exp, reg_of(scale(series(multiply(a, a)), constants_.literal(-1))));
        const std::uint32_t slope = reg_of(scale(std::move(bell), constants_.literal(two_over_root_pi)));
        return series(emit(SeriesOperation::erf, emit(SeriesOperation::derivative, a), slope, a));
    }
    default:
        return series(inverse_function(operation, a));
    }
}

std::uint32_t SeriesBuilder::hyperbolic_or_circular(SeriesOperation one, SeriesOperation other, std::uint32_t a,
                                                    bool want_one) {
    const std::uint32_t derivative = emit(SeriesOperation::derivative, a);
    const Key key{static_cast<std::uint32_t>(one), a};
    const auto [found, added] = known_.try_emplace(key, registers_);
    if (added) {
        code_.push_back({one, registers_, derivative, registers_ + 1, a});
        code_.push_back({other, registers_ + 1, derivative, registers_, a});
        registers_ += 2;
    }
    return want_one ? found->second : found->second + 1;
}

std::uint32_t SeriesBuilder::tangent(Operation operation, std::uint32_t a) {
    const bool circular = operation == Operation::tan;
    const SeriesOperation kind = circular ? SeriesOperation::tan : SeriesOperation::tanh;
    const std::uint32_t derivative = emit(SeriesOperation::derivative, a);
    const Key key{static_cast<std::uint32_t>(kind), a};
    const auto [found, added] = known_.try_emplace(key, registers_);
    const std::uint32_t result = found->second;
    if (added) {
        ++registers_;
        const std::size_t index = code_.size();
        code_.push_back({kind, result, derivative, 0, a});
        const std::uint32_t slope = one_and_square(result, circular ? 1 : -1);
        code_[index].right = slope;
    }
    return result;
}

std::uint32_t SeriesBuilder::inverse_function(Operation operation, std::uint32_t a) {
    const std::uint32_t derivative = emit(SeriesOperation::derivative, a);
    SeriesOperation kind = SeriesOperation::log;
    std::uint32_t denominator = a;
    if (operation == Operation::atan) {
        kind = SeriesOperation::atan;
        denominator = one_and_square(a, 1);
    } else if (operation != Operation::log) {
        kind = operation == Operation::asin ? SeriesOperation::asin : SeriesOperation::acos;
        denominator = emit(SeriesOperation::sqrt, one_and_square(a, -1));
    }
    return emit(kind, emit(SeriesOperation::divide, derivative, denominator), 0, a);
}

std::uint32_t SeriesBuilder::one_and_square(std::uint32_t a, double sign) {
    const std::uint32_t square = multiply(a, a);
    return reg_of({one_, {{square, constants_.literal(sign)}}});
}

std::uint32_t SeriesBuilder::multiply(std::uint32_t left, std::uint32_t right) {
    if (left == right) {
        const std::uint32_t result = emit(SeriesOperation::square, left);
        roots_.emplace(result, left);
        return result;
    }
    // The kernel needs its right operand last: let it be the one computed later.
    return emit(SeriesOperation::multiply, std::min(left, right), std::max(left, right));
}

SeriesBuilder::Key SeriesBuilder::key_of(SeriesOperation operation, std::uint32_t left, std::uint32_t right,
                                         std::uint32_t third) {
    return {static_cast<std::uint32_t>(operation), left, right, third};
}

std::uint32_t SeriesBuilder::emit(SeriesOperation operation, std::uint32_t left, std::uint32_t right,
                                  std::uint32_t third) {
    const auto [found, added] = known_.try_emplace(key_of(operation, left, right, third), registers_);
    if (added)
        code_.push_back({operation, registers_++, left, right, third});
    return found->second;
}

SeriesBuilder::Scaled SeriesBuilder::split(const LinearForm& form) {
    if (form.terms.size() == 1 && form.constant == zero_)
        return {form.terms[0].coefficient, form.terms[0].series};
    return {one_, reg_of(form)};
}

std::uint32_t SeriesBuilder::reg_of(const LinearForm& form) {
    if (form.terms.size() == 1 && form.constant == zero_ && form.terms[0].coefficient == one_)
        return form.terms[0].series;
    Key key{static_cast<std::uint32_t>(SeriesOperation::linear_combination), form.constant};
    for (const Term& term : form.terms) {
        key.push_back(term.series);
        key.push_back(term.coefficient);
    }
    const auto [found, added] = known_.try_emplace(std::move(key), registers_);
    if (added) {
        const auto first = static_cast<std::uint32_t>(terms_.size());
        terms_.insert(terms_.end(), form.terms.begin(), form.terms.end());
        code_.push_back({SeriesOperation::linear_combination, registers_++, first,
                         static_cast<std::uint32_t>(terms_.size()), form.constant});
    }
    return found->second;
}

} // namespace graze
