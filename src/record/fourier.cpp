#include "record/fourier.hpp"

#include <bit>
#include <cstddef>
#include <exception>
#include <numbers>
#include <utility>

namespace graze {

namespace {

using Complex = std::complex<double>;

/// Ends a transform that was interrupted.
class Interrupted : public std::exception {};

/// Asks at the first and then at every 65536th step of a loop. @throws Interrupted
void ask(const std::function<bool()>& interrupted, std::size_t step) {
    constexpr std::size_t steps = 1 << 16;
    if (step % steps == 0 && interrupted && interrupted())
        throw Interrupted();
}

/// Products are written out, since std::complex multiplication checks for infinities.
Complex product(const Complex& a, const Complex& b) {
    return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

/// In-place transforms of one power-of-two length.
class Transform {
public:
    /// @param interrupted has to live as long
    Transform(std::size_t count, const std::function<bool()>& interrupted) : turns_(count), interrupted_(interrupted) {
        const std::size_t half = count / 2;
        for (std::size_t i = half; i < count; ++i) {
            ask(interrupted, i);
            turns_[i] =
                std::polar(1.0, -2 * std::numbers::pi * static_cast<double>(i - half) / static_cast<double>(count));
        }
        for (std::size_t i = half; i-- > 1;)
            turns_[i] = turns_[2 * i];
    }

    void operator()(std::vector<Complex>& values) const {
        reorder(values);
        combine(values);
    }

private:
    static constexpr std::size_t in_cache = 1 << 14; ///< as many values are in the processor's cache together

    /// Bits of the indices reversed.
    void reorder(std::vector<Complex>& values) const {
        for (std::size_t i = 1, j = 0; i < values.size(); ++i) {
            ask(interrupted_, i);
            std::size_t bit = values.size() >> 1;
            for (; j & bit; bit >>= 1)
                j ^= bit;
            j ^= bit;
            if (i < j)
                std::swap(values[i], values[j]);
        }
    }

    void combine(std::span<Complex> values) const {
        if (values.size() > in_cache) { // each half to its end first: memory is slower than the processor
            combine(values.first(values.size() / 2));
            combine(values.last(values.size() / 2));
            combine_halves(values);
        } else {
            ask(interrupted_, 0);
            for (std::size_t length = 2; length <= values.size(); length *= 2)
                for (std::size_t begin = 0; begin < values.size(); begin += length)
                    combine_halves(values.subspan(begin, length));
        }
    }

    void combine_halves(std::span<Complex> values) const {
        const std::size_t half = values.size() / 2;
        const std::span<const Complex> turns(&turns_[half], half);
        for (std::size_t i = 0; i < half; ++i) { // in real numbers, which compilers make faster code of
            Complex &even = values[i], &odd = values[half + i];
            const double c = turns[i].real(), s = turns[i].imag();
            const double real = c * odd.real() - s * odd.imag(), imaginary = c * odd.imag() + s * odd.real();
            const double even_real = even.real(), even_imaginary = even.imag();
            even = {even_real + real, even_imaginary + imaginary};
            odd = {even_real - real, even_imaginary - imaginary};
        }
    }

    std::vector<Complex> turns_; ///< from index L/2 on: exp(-2 pi i j/L), j = 0 ... L/2 - 1, for each power of two L
    const std::function<bool()>& interrupted_;
};

std::vector<Complex> transform_of_power(std::span<const double> samples, const std::function<bool()>& interrupted) {
    std::vector<Complex> values(samples.begin(), samples.end());
    Transform(values.size(), interrupted)(values);
    values.resize(values.size() / 2 + 1);
    return values;
}

std::vector<Complex> transform_of_any(std::span<const double> samples, const std::function<bool()>& interrupted) {
    const std::size_t count = samples.size();
    // By j k = (j^2 + k^2 - (k - j)^2)/2 the sums are a convolution.
    std::vector<Complex> chirp(count);
    for (std::size_t j = 0; j < count; ++j) {
        ask(interrupted, j);
        const std::size_t square = j * j % (2 * count);
        chirp[j] = std::polar(1.0, -std::numbers::pi * static_cast<double>(square) / static_cast<double>(count));
    }
    const std::size_t size = std::bit_ceil(2 * count);
    std::vector<Complex> a(size), b(size);
    for (std::size_t j = 0; j < count; ++j) {
        a[j] = samples[j] * chirp[j];
        b[j] = b[(size - j) % size] = std::conj(chirp[j]);
    }
    const Transform transform(size, interrupted);
    transform(a);
    transform(b);
    for (std::size_t i = 0; i < size; ++i)
        a[i] = std::conj(product(a[i], b[i])); // the inverse transform is the conjugate of that of the conjugate
    transform(a);
    std::vector<Complex> result(count / 2 + 1);
    for (std::size_t k = 0; k < result.size(); ++k)
        result[k] = product(std::conj(a[k]), chirp[k]) / static_cast<double>(size);
    return result;
}

} // namespace

std::vector<Complex> half_transform(std::span<const double> samples, const std::function<bool()>& interrupted) {
    if (samples.empty())
        return {};
    try {
        return std::has_single_bit(samples.size()) ? transform_of_power(samples, interrupted)
                                                   : transform_of_any(samples, interrupted);
    } catch (const Interrupted&) {
        return {};
    }
}

} // namespace graze
