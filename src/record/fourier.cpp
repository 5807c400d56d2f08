#include "record/fourier.hpp"

#include <bit>
#include <cstddef>
#include <numbers>
#include <utility>

namespace graze {

namespace {

using Complex = std::complex<double>;

/// In-place transform of a power-of-two length. @param sign of the exponent
void transform(std::vector<Complex>& values, int sign) {
    const std::size_t count = values.size();
    for (std::size_t i = 1, j = 0; i < count; ++i) {
        std::size_t bit = count >> 1;
        for (; j & bit; bit >>= 1)
            j ^= bit;
        j ^= bit;
        if (i < j)
            std::swap(values[i], values[j]);
    }
    std::vector<Complex> turns(count / 2);
    for (std::size_t i = 0; i < turns.size(); ++i)
        turns[i] = std::polar(1.0, sign * 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count));
    for (std::size_t length = 2; length <= count; length *= 2)
        for (std::size_t begin = 0; begin < count; begin += length)
            for (std::size_t i = 0; i < length / 2; ++i) {
                const Complex even = values[begin + i], turn = turns[i * (count / length)],
                              other = values[begin + i + length / 2];
                // Written out, since std::complex multiplication checks for infinities.
                const Complex odd(turn.real() * other.real() - turn.imag() * other.imag(),
                                  turn.real() * other.imag() + turn.imag() * other.real());
                values[begin + i] = even + odd;
                values[begin + i + length / 2] = even - odd;
            }
}

} // namespace

std::vector<Complex> half_transform(std::span<const double> samples) {
    const std::size_t count = samples.size();
    if (count == 0)
        return {};
    // By j k = (j^2 + k^2 - (k - j)^2)/2 the sums are a convolution.
    std::vector<Complex> chirp(count);
    for (std::size_t j = 0; j < count; ++j) {
        const std::size_t square = j * j % (2 * count);
        chirp[j] = std::polar(1.0, -std::numbers::pi * static_cast<double>(square) / static_cast<double>(count));
    }
    const std::size_t size = std::bit_ceil(2 * count);
    std::vector<Complex> a(size), b(size);
    for (std::size_t j = 0; j < count; ++j) {
        a[j] = samples[j] * chirp[j];
        b[j] = b[(size - j) % size] = std::conj(chirp[j]);
    }
    transform(a, -1);
    transform(b, -1);
    for (std::size_t i = 0; i < size; ++i)
        a[i] *= b[i];
    transform(a, 1);
    std::vector<Complex> result(count / 2 + 1);
    for (std::size_t k = 0; k < result.size(); ++k)
        result[k] = a[k] * chirp[k] / static_cast<double>(size);
    return result;
}

} // namespace graze
