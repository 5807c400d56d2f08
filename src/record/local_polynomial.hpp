#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// Least-squares fits of polynomials to samples at fixed places, in an orthonormal basis: of white noise each
/// coefficient has the standard deviation of a sample, independently of the others.
class LocalPolynomial {
public:
    /// @param places distinct, of the order of one; more of them than the degree
    LocalPolynomial(std::span<const double> places, std::size_t degree);

    std::size_t degree() const { return at_zero_.size() - 1; }
    std::size_t places() const { return places_; }
    /// Coefficient k of the basis. @param samples one at each place
    double coefficient(std::size_t k, const double* samples) const {
        const double* basis = basis_.data() + k * places_;
        double sum = 0;
        for (std::size_t i = 0; i < places_; ++i)
            sum += basis[i] * samples[i];
        return sum;
    }
    /// Squares that are left of samples when the polynomial with these coefficients, as many as given, is taken away.
    double squares_left(const double* samples, std::span<const double> coefficients) const {
        double squares = 0;
        for (std::size_t i = 0; i < places_; ++i) {
            double rest = samples[i];
            for (std::size_t k = 0; k < coefficients.size(); ++k)
                rest -= coefficients[k] * basis_[k * places_ + i];
            squares += rest * rest;
        }
        return squares;
    }
    /// Value and slope at nought of polynomial k of the basis.
    double at_zero(std::size_t k) const { return at_zero_[k]; }
    double slope_at_zero(std::size_t k) const { return slope_[k]; }
    /// Coefficients of powers, from the lowest, of the polynomial that fits best.
    std::vector<double> powers(const double* samples) const;

private:
    std::size_t places_;
    std::vector<double> basis_; ///< one after the other
    std::vector<double> at_zero_, slope_;
    std::vector<double> inverse_; ///< powers of each, one after the other
};

} // namespace graze
