#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// Value of a polynomial. @param powers coefficients of powers, from the lowest
inline double polynomial_at(const std::vector<double>& powers, double x) {
    double sum = 0;
    for (std::size_t k = powers.size(); k-- > 0;)
        sum = sum * x + powers[k];
    return sum;
}

/// Least-squares fits of polynomials to samples at fixed places, in an orthonormal basis: with white noise the
/// coefficients are independent, each with the standard deviation of a sample.
class LocalPolynomial {
public:
    /// @param places distinct, of order one; more of them than the degree
    LocalPolynomial(std::span<const double> places, std::size_t degree);

    std::size_t degree() const { return at_zero_.size() - 1; }
    /// Returns the coefficient of basis polynomial k. @param samples one at each place
    double coefficient(std::size_t k, const double* samples) const {
        const double* basis = basis_.data() + k * places_;
        double sum = 0;
        for (std::size_t i = 0; i < places_; ++i)
            sum += basis[i] * samples[i];
        return sum;
    }
    /// Returns the sum of squared residuals of the polynomial with the given coefficients (of the first basis
    /// polynomials).
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
    /// Value and slope at 0 of basis polynomial k.
    double at_zero(std::size_t k) const { return at_zero_[k]; }
    double slope_at_zero(std::size_t k) const { return slope_[k]; }
    /// Returns the best polynomial's coefficients of powers, from the lowest.
    std::vector<double> powers(const double* samples) const;

private:
    std::size_t places_;
    std::vector<double> basis_; ///< values at the places, one polynomial after the other
    std::vector<double> at_zero_, slope_;
    std::vector<double> inverse_; ///< coefficients of powers of each basis polynomial
};

} // namespace graze
