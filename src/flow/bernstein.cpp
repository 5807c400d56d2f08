#include "bernstein.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace graze::bernstein {

namespace {

/// Counts the most sign variations that a sequence with signs +1, -1 and 0 (unknown) may have, up to 2.
class VariationCounter {
public:
    /// @return whether to continue
    bool add(int sign) {
        if (sign == 0) {
            ++unknown_;
            return true;
        }
        // A run of m unknown signs between two known ones can hide m + 1 variations if the parity allows.
        if (last_ == 0)
            count_ += unknown_;
        else
            count_ += unknown_ + (((unknown_ + 1) % 2 == 1) == (sign != last_) ? 1 : 0);
        last_ = sign;
        unknown_ = 0;
        return count_ < 2;
    }
    int count() const { return std::min(2, count_ + (last_ == 0 ? std::max(0, unknown_ - 1) : unknown_)); }

private:
    int last_ = 0, unknown_ = 0, count_ = 0;
};

int sign_beyond(double value, double uncertainty) {
    return (value > uncertainty) - (value < -uncertainty);
}

std::size_t first_nonzero(std::span<const BernsteinCoefficient> b) {
    std::size_t i = 0;
    while (i + 1 < b.size() && b[i].bound == 0)
        ++i;
    return i;
}

struct DoubleDouble {
    double high, low;
};

/// Returns a + x b.
DoubleDouble add_product(DoubleDouble a, double x, DoubleDouble b) {
    const double product = x * b.high;
    const double product_low = std::fma(x, b.high, -product) + x * b.low;
    const double sum = a.high + product;
    const double part = sum - a.high;
    const double low = (a.high - (sum - part)) + (product - part) + (a.low + product_low);
    const double high = sum + low;
    return {high, low - (high - sum)};
}

} // namespace

void from_power(std::span<BernsteinCoefficient> b, std::span<const double> reciprocals) {
    const std::size_t size = b.size();
    for (std::size_t k = 0; k < size; ++k) {
        b[k].value *= reciprocals[k];
        b[k].bound *= reciprocals[k];
    }
    for (std::size_t j = 1; j < size; ++j) {
        for (std::size_t i = size - 1; i >= j; --i) {
            b[i].value += b[i - 1].value;
            b[i].bound += b[i - 1].bound;
        }
    }
}

void halve(std::span<BernsteinCoefficient> b, std::span<BernsteinCoefficient> left) {
    const std::size_t degree = b.size() - 1;
    left[0] = b[0];
    for (std::size_t j = 1; j <= degree; ++j) {
        for (std::size_t i = 0; i <= degree - j; ++i) {
            b[i].value = 0.5 * (b[i].value + b[i + 1].value);
            b[i].bound = 0.5 * (b[i].bound + b[i + 1].bound);
        }
        left[j] = b[0];
    }
}

void expand(std::span<const double> c, double left, double width, double error, std::span<const double> reciprocals,
            std::span<BernsteinCoefficient> b) {
    const std::size_t size = c.size();
    for (std::size_t k = 0; k < size; ++k) // during the shift, value and bound hold a double-double number
        b[k] = {c[k], 0};
    for (std::size_t i = 0; i + 1 < size; ++i) {
        for (std::size_t j = size - 1; j-- > i;) {
            const DoubleDouble sum = add_product({b[j].value, b[j].bound}, left, {b[j + 1].value, b[j + 1].bound});
            b[j] = {sum.high, sum.low};
        }
    }
    double power = 1;
    for (std::size_t k = 0; k < size; ++k) {
        b[k].value = (b[k].value + b[k].bound) * power;
        b[k].bound = std::abs(b[k].value);
        power *= width;
    }
    // The error of the shift is about n 2^-104 sum |c_k| s^k; error is at least 4 u times that sum, and bounds are
    // multiplied by more than 8 u.
    b[0].bound += 64 * error;
    from_power(b, reciprocals);
}

Range range(std::span<const BernsteinCoefficient> b, double scale, double floor) {
    Range result{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(), 0};
    for (std::size_t i = first_nonzero(b); i < b.size(); ++i) {
        const double uncertainty = scale * b[i].bound + floor;
        result.low = std::min(result.low, b[i].value - uncertainty);
        result.high = std::max(result.high, b[i].value + uncertainty);
        result.uncertainty = std::max(result.uncertainty, uncertainty);
    }
    return result;
}

int root_variations(std::span<const BernsteinCoefficient> b, double scale, double floor) {
    VariationCounter counter;
    for (std::size_t i = first_nonzero(b); i < b.size(); ++i)
        if (!counter.add(sign_beyond(b[i].value, scale * b[i].bound + floor)))
            break;
    return counter.count();
}

int extremum_variations(std::span<const BernsteinCoefficient> b, double scale) {
    VariationCounter counter;
    std::size_t i = 0;
    while (i + 1 < b.size() && b[i + 1].bound == 0)
        ++i;
    for (; i + 1 < b.size(); ++i)
        if (!counter.add(sign_beyond(b[i + 1].value - b[i].value, scale * (b[i + 1].bound + b[i].bound))))
            break;
    return counter.count();
}

} // namespace graze::bernstein
