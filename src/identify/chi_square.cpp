#include "identify/chi_square.hpp"

#include <cmath>

namespace graze {

double chi_square_tail(double squares, std::size_t freedom) {
    if (freedom == 0 || !(squares > 0))
        return 1;
    // Recurrence of the incomplete gamma function in its parameter, from 1/2 or 1 up to freedom/2; all terms are
    // positive, so nothing cancels.
    const double x = 0.5 * squares;
    const bool odd = freedom % 2 == 1;
    double tail = odd ? std::erfc(std::sqrt(x)) : std::exp(-x);
    for (std::size_t k = odd ? 1 : 2; k + 2 <= freedom; k += 2) {
        const double a = 0.5 * static_cast<double>(k);
        tail += std::exp(a * std::log(x) - x - std::lgamma(a + 1));
    }
    return tail < 1 ? tail : 1;
}

} // namespace graze
