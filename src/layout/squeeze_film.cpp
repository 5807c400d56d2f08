#include "graze/layout/squeeze_film.hpp"

#include "layout/require_size.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace graze {

namespace {

constexpr double standard_atmosphere = 101325; // Pa

void require_gas(const Gas& gas) {
    require_positive(gas.pressure, "pressure of the gas", "Pa");
    require_positive(gas.viscosity, "viscosity of the gas", "Pa s");
    require_positive(gas.mean_free_path, "mean free path of the gas");
}

void require_film(const GasFilm& film) {
    require_positive(film.length, "length of the film");
    require_positive(film.height, "height of the film");
    require_positive(film.gap, "gap of the film");
}

/// Ratio of the damping of a finite film to that of a long one. @param ratio of the shorter side to the longer
double share_of_finite(double ratio) {
    double sum = 0;
    for (int n = 1;; n += 2) {
        const double term = std::pow(n, -5) * std::tanh(0.5 * n * std::numbers::pi / ratio);
        if (sum + term == sum)
            break;
        sum += term;
    }
    return 1 - 192 * ratio * std::pow(std::numbers::pi, -5) * sum;
}

/// 12 (I2 - I1^2/I0) of a gap 1 + a x, x from -1 to 1, in units of (height/mean gap)^3: 3 (artanh(a)/a - 1)/a^2.
double cross_section(double a) {
    constexpr double small = 0.1; // below this the difference cancels
    if (std::abs(a) >= small)
        return 3 * (std::atanh(a) / a - 1) / (a * a);
    double sum = 0, power = 1;
    for (int j = 3; sum + power / j != sum; j += 2) {
        sum += power / j;
        power *= a * a;
    }
    return 3 * sum;
}

} // namespace

double mean_free_path_of(const Gas& gas) {
    require_gas(gas);
    return gas.mean_free_path * (standard_atmosphere / gas.pressure);
}

double effective_viscosity(const Gas& gas, double gap) {
    require_positive(gap, "gap of the film");
    constexpr double factor = 9.638, power = 1.159; // of the fit by Veijola et al.
    return gas.viscosity / (1 + factor * std::pow(mean_free_path_of(gas) / gap, power));
}

double squeeze_film_damping(const GasFilm& film, const Gas& gas) {
    require_film(film);
    const double mean = film.gap.mean(), change = 0.5 * (film.gap.bottom - film.gap.top) / mean;
    const double ratio = std::min(film.height, film.length) / std::max(film.height, film.length);
    const double slender = film.height / mean;
    // If the film is higher than long, the flow is along the length; the factor is symmetric.
    const double along = film.height <= film.length ? 1 : ratio * ratio;
    return effective_viscosity(gas, mean) * film.length * slender * slender * slender * along * cross_section(change) *
           share_of_finite(ratio);
}

double squeeze_number(const GasFilm& film, const Gas& gas, double angular_frequency) {
    require_film(film);
    require_positive(angular_frequency, "angular frequency", "rad/s");
    const double side = std::min(film.height, film.length) / film.gap.mean();
    return 12 * effective_viscosity(gas, film.gap.mean()) * angular_frequency * (side / gas.pressure) * side;
}

double sliding_film_damping(double area, double gap, const Gas& gas) {
    require_positive(area, "area of the plate", "m^2");
    require_positive(gap, "gap of the film");
    return gas.viscosity * (area / (gap + 2 * mean_free_path_of(gas)));
}

} // namespace graze
